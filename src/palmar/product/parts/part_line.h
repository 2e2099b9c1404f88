// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::product {

/// What a centre line is measured from.
struct LineRequest {
  std::vector<Vec3> line;      ///< a rough centre line, product frame, mm
  std::vector<double> radius;  ///< of the solid at each of its points, mm
  bool is_ring = false;
  std::array<bool, 2> is_free = {true, true};  ///< ends at which the product ends
  bool is_in_loop = false;   ///< its ends bend into what they join; else a bend there isn't its own
  double gap = 12.0;         ///< mm; what is less apart in a section counts as one
  std::vector<Vec3> points;  ///< of the part's surface: how far it reaches at a free end
};

struct MeasuredLine {
  std::vector<Vec3> line;  ///< centre line, ends included (a ring: its first point isn't repeated)
  std::vector<PartSection> sections;
  double length = 0.0;
};

/// Draws a rough line to the middle of the sections across it, again and again; lets free ends run
/// to the end of the surface and joined ends to where the girth has grown by kGirthOfJoint (what
/// they join begins there); then measures sections evenly along it. Empty if there are no sections.
MeasuredLine measure_line(const geometry::TriangleMesh& mesh, const LineRequest& request);

/// Sections along a straight axis through a piece of surface: hulls of everything that the planes
/// meet, so that gaps (where a handle was taken off) don't matter.
MeasuredLine measure_axis(const geometry::TriangleMesh& piece, const Vec3& point, const Vec3& axis);

}  // namespace palmar::product
