// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "palmar/product/product_faces.h"

namespace palmar::product {

/// Section of a bar along z, counter-clockwise about the origin, and on which side of the bar each
/// of its segments lies.
struct BarSection {
  std::vector<Eigen::Vector2d> points;  ///< mm
  std::vector<int> side;                ///< of the segment from this point to the next
};

/// What a side of the bar is.
struct BarSide {
  std::string name;     ///< "front", "fillet 1"
  double radius = 0.0;  ///< mm; 0: a plane
  bool is_fillet = false;
  double width = 0.0;  ///< mm; across the bar, along the section
};

/// How the mesh of the bar is made: fan and rings of the lower end, rings along it, then those of
/// the upper end, each of them two triangles per segment of the section.
struct BarRings {
  double length = 0.0;    ///< mm, along z, about the origin
  double end_area = 0.0;  ///< mm^2
  int along = 1;          ///< rows of quadrilaterals along the bar
  int on_ends = 1;        ///< rows on an end; the innermost is a fan
};

/// Faces and edges of the bar: its sides in their order, then "bottom" and "top"; sides that no
/// segment lies on are left out. Edges run along the bar between neighbouring sides, then round
/// the bottom and the top.
std::shared_ptr<const ProductFaces> bar_faces(const BarSection& section,
                                              const std::vector<BarSide>& sides,
                                              const BarRings& rings);

}  // namespace palmar::product
