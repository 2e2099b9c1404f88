// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "palmar/product/parts/part_regions.h"
#include "palmar/product/parts/skeleton_pieces.h"

namespace palmar::product {

/// Two pieces that share a node, a < b.
struct PieceJoint {
  int a, b;
  bool is_limb;  ///< one stands out of the other
};

/// Pieces of a skeleton in groups that are parts of the solid.
struct PieceGroups {
  std::vector<int> group;                   ///< of each piece: the lowest piece in it
  std::vector<PartRegion> region;           ///< of the group at its lowest piece; mm
  std::map<int, std::vector<int>> at_node;  ///< pieces that end at or pass a node
  std::vector<PieceJoint> joints;
};

/// Puts together pieces whose common hull has no deep hollow (Lien, Amato 2007: approximate convex
/// decomposition), the nearest to convex first; so a body, however many lines run through it, is
/// one group and a handle on it another. Neighbours share a node or a wide border. `regions` has
/// one region per piece.
PieceGroups grouped_pieces(const SolidGrid& grid, const SkeletonPieces& skeleton,
                           const PartRegions& regions);

}  // namespace palmar::product
