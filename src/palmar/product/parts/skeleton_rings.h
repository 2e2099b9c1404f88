// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/voxel_skeleton.h"

namespace palmar::product {

/// A closed way through a skeleton; its first point isn't repeated. Grid's frame, mm.
struct SkeletonRing {
  std::vector<Vec3> point;
  std::vector<double> radius;  ///< depth of the solid at each point
  double length = 0.0;
};

/// The shortest independent rings of a skeleton, as many as the solid has tunnels, shortest first:
/// one round each opening. Of rings that share lines (the two of scissors, whose shanks meet) each
/// is told, which no single line between two nodes says.
///
/// Source: Horton 1987, "A polynomial-time algorithm to find the shortest cycle basis of a graph",
/// with the candidates reduced to one ring per line: the shortest way from one of its ends to the
/// other without it.
std::vector<SkeletonRing> rings_of(const SkeletonGraph& graph);

}  // namespace palmar::product
