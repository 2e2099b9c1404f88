// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"
#include "palmar/product/parts/rough_parts.h"
#include "palmar/product/parts/solid_grid.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar::product {

/// Rings that no part goes round yet: two rings that lie closer than a finger's breadth (those of
/// scissors) meet in the grid, so that the line of one is cut where the other touches it, or both
/// are one sheet. The part that makes up most of such a ring gets a closed line, or, where it has
/// more than that, the ring becomes a part of its own; if the ring is a bar round at least 0.6 of
/// its opening (no thicker than a hand closes round, nowhere there 1.6 times as thick as usual) and
/// a disc of diameter `finger` [mm] passes through it.
void complete_rings(const geometry::TriangleMesh& mesh, const SolidGrid& grid,
                    const SkeletonGraph& graph, double finger, RoughParts& rough);

}  // namespace palmar::product
