// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct LowTrianglesResult {
  TriangleMesh mesh;         ///< same vertices
  std::vector<Vec3> places;  ///< centres of the triangles that went, mm
  std::vector<Vec3> left;    ///< centres of those that stay low, mm
};

/// Triangles whose least height is at most `height` [mm], so nearly none of area: their longest
/// edge is turned within the pair of triangles it lies in (the corner in its middle then belongs to
/// both new ones), or, if it is a free edge, they are dropped. The surface moves by `height` at
/// most and no edge gets a third triangle. Left are those whose turn would bring another low one,
/// and those at edges whose triangles disagree about outside. Corners must be in the list.
LowTrianglesResult repair_low_triangles(const TriangleMesh& mesh, double height);

/// Least height of a triangle [mm]; 0 if it has no area.
double least_height(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace palmar::geometry
