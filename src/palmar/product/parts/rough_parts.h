// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/part_regions.h"
#include "palmar/product/parts/skeleton_pieces.h"
#include "palmar/product/parts/solid_grid.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar::product {

/// A part of a solid before it is measured.
struct RoughPart {
  std::vector<Vec3> line;      ///< its centre line if it is a single one; grid's frame, mm
  std::vector<double> radius;  ///< mm
  bool is_ring = false;        ///< the line is closed
  std::array<int, 2> end_part = {-1, -1};  ///< what the line's ends join; -1: free
  bool is_in_loop = false;                 ///< the line's ends stay joined if it is taken away
  double volume = 0.0;                     ///< mm^3
};

struct RoughParts {
  std::vector<RoughPart> parts;
  std::vector<SolidBall> balls;            ///< on the lines
  std::vector<std::array<int, 2>> joints;  ///< parts that touch, ascending
};

/// Cuts the lines of a skeleton where the solid becomes much thinner or goes round a corner
/// (skeleton_pieces.h) and puts together again what is nearly convex (piece_groups.h); so a body,
/// however many lines run through it, is one part and a handle on it another.
RoughParts rough_parts(const SolidGrid& grid, const SkeletonGraph& graph, const GirthAt& girth_at);

}  // namespace palmar::product
