// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// The triangles of a mesh divided again and again by kParts (4 or 8), at the median centroid of
/// the longest side: the frame that nearest-point search and winding number hang their own data on.
template <int kParts>
struct WideTrianglePartition {
  static constexpr int kWidth = kParts;

  struct Node {
    std::array<int, kWidth> begin{};  ///< part k holds order[begin[k]] ... order[end[k] - 1]
    std::array<int, kWidth> end{};
    std::array<int, kWidth> child{};  ///< node of part k; -1 if it isn't divided further

    int size(int k) const { return end[k] - begin[k]; }
  };

  std::vector<int> order;  ///< triangles, neighbours in space near each other
  std::vector<Node>
      nodes;  ///< the root first, children behind their parent; empty without triangles
};
using TrianglePartition = WideTrianglePartition<4>;

/// Parts of at most `leaf_size` triangles are not divided further. Deterministic; degenerate
/// triangles are kept.
template <int kParts = 4>
WideTrianglePartition<kParts> partition_triangles(const TriangleMesh& mesh, int leaf_size);

/// Throws InputError on a coordinate that is not finite and on a corner outside the vertex list.
void check_finite_and_indexed(const TriangleMesh& mesh);

}  // namespace palmar::geometry
