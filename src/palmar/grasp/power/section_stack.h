// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::grasp {

/// One outer outline of a plane section of a product. Holes (the inner wall of a mug) are left out:
/// a hand never feels them.
struct SectionOutline {
  Vec3 centroid = Vec3::Zero();  ///< of the enclosed area, mm
  double area = 0.0;             ///< enclosed, mm^2
  double girth = 0.0;            ///< perimeter of the convex hull (what a tape measures), mm
  double thickness = 0.0;        ///< smallest distance of two parallel tangents, mm
  double width = 0.0;            ///< extent across the thickness, mm
  Vec3 wide = Vec3::UnitX();     ///< unit direction of the width, in the plane
};

/// The outlines in one plane of a stack.
struct Section {
  double station = 0.0;  ///< position along the axis, mm
  std::vector<SectionOutline> outlines;
};

/// Cuts a mesh by planes perpendicular to the unit vector `axis`, `spacing` [mm] apart, from half a
/// spacing inside the lower end to the upper end. Stations are dot products with `axis`. Outlines
/// below 3 mm of girth are noise of a scan and are left out. An open outline (gap in the mesh) is
/// closed by a straight line. Empty for an empty mesh.
std::vector<Section> sections_along(const geometry::TriangleMesh& mesh, const Vec3& axis,
                                    double spacing);

}  // namespace palmar::grasp
