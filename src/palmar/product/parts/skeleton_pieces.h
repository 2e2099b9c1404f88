// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar::product {

/// A stretch of a skeleton's lines on which the solid neither becomes much thinner nor goes round a
/// corner; grid's frame, mm.
struct SkeletonPiece {
  std::vector<Vec3> point;
  std::vector<double> radius;                     ///< depth of the solid at each point
  std::array<int, 2> node = {-1, -1};             ///< -1: ring
  std::array<bool, 2> is_cut = {false, false};    ///< thinner than what goes on at that end
  std::array<bool, 2> is_thick = {false, false};  ///< thicker than the limb that begins at that end
  std::array<bool, 2> is_free = {false, false};
  std::vector<int> passed;             ///< nodes within ...
  std::vector<std::size_t> passed_at;  ///< ... and at which point
  double length = 0.0;

  double mean_radius() const;
};

struct SkeletonPieces {
  std::vector<SkeletonPiece> pieces;
  int nodes = 0;  ///< of the graph and those at cuts
};

/// How long a tape round the product is at a point (grid's frame) across a direction, mm; 0 if
/// there is nothing.
using GirthAt = std::function<double(const Vec3& point, const Vec3& direction)>;

/// Lines that go straight on through a node of the graph, with about the same radius and girth,
/// become one; then they are cut where the solid becomes much thinner or goes round a corner.
SkeletonPieces skeleton_pieces(const SkeletonGraph& graph, double spacing, const GirthAt& girth_at);

}  // namespace palmar::product
