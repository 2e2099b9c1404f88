// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// One curve of a plane section: corners in order, mm. A closed curve doesn't repeat its first
/// corner; seen against the plane's normal it runs counter-clockwise round solid material.
struct SectionCurve {
  std::vector<Vec3> point;
  bool is_closed = false;
};

/// Curves in which a mesh meets the plane through `point` with unit normal `normal`, exact to
/// rounding: one corner per edge crossed. A vertex in the plane counts as lying on the normal's
/// side, so touching faces give no curve. In order of their smallest triangle. A closed mesh gives
/// closed curves only. Throws UsageError if `normal` is not of unit length.
std::vector<SectionCurve> plane_section(const TriangleMesh& mesh, const Vec3& point,
                                        const Vec3& normal);

/// Length of a curve, mm.
double curve_length(const SectionCurve& curve);

/// Mean of a curve along its length; zero for an empty one.
Vec3 curve_centre(const SectionCurve& curve);

/// Extent of points along a unit direction, mm; 0 for none.
double extent(const std::vector<Vec3>& points, const Vec3& direction);

/// Length of a tape put round points of a plane with unit normal `normal`: perimeter of their
/// convex hull, mm. 0 for fewer than two distinct points.
double girth(const std::vector<Vec3>& points, const Vec3& normal);

}  // namespace palmar::geometry
