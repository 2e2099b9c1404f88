// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/product/parts/product_parts.h"

namespace palmar::product {

/// What a part's kind follows from besides its sections.
struct PartShape {
  bool has_line = false;       ///< a centre line of its own, with sections in the part
  bool is_in_loop = false;     ///< its ends stay joined without it
  int joints = 0;              ///< parts that it touches
  Vec3 extent = Vec3::Zero();  ///< along the axes of its surface's spread, largest first, mm
  double roundness = 2.0;  ///< farthest / root mean square distance of its surface from its middle
  double across_faces = 0.0;  ///< extent along the direction that most of its surface faces, mm
};

PartKind kind_of(const ProductPart& part, const PartShape& shape);

/// Whether a hand closes round a part and it is long enough for that.
bool is_bar_by_size(const ProductPart& part);

/// Gives every part its plain name by its kind, size and what it joins.
void name_parts(std::vector<ProductPart>& parts);

}  // namespace palmar::product
