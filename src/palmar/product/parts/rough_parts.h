// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/solid_grid.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar {

/// A ball of the solid, in the grid's frame, mm.
struct SolidBall {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  int part = 0;
};

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

/// Cuts the lines of a skeleton where the solid becomes much thinner or goes round a corner, and
/// puts together again what is nearly convex, measured by how deep a hollow its hull has (Lien,
/// Amato 2007: approximate convex decomposition); so a body, however many lines run through it, is
/// one part and a handle on it another.
///
/// `girth_at` says how long a tape round the product is at a point (grid's frame) across a
/// direction; 0 if there is nothing. Lines go on as one through a node only if it doesn't change
/// much.
using GirthAt = std::function<double(const Vec3& point, const Vec3& direction)>;
RoughParts rough_parts(const SolidGrid& grid, const SkeletonGraph& graph, const GirthAt& girth_at);

/// Part of the ball that a point is nearest to (distance to its surface).
int nearest_part(const std::vector<SolidBall>& balls, const Vec3& point);

}  // namespace palmar
