// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

struct RemeshOptions {
  double edge_length = 2.5;  ///< wanted mean edge, mm; reached within about 3 %
  int rounds = 12;           ///< split, collapse, flip, relax; 0 to 100. 12 settle the triangles
  void check() const;        ///< throws UsageError: field, value, allowed range
};

struct RemeshResult {
  TriangleMesh mesh;
  /// Per vertex: where it lies on the input, so that fields of the input can be carried over.
  std::vector<int> triangle;                   ///< of the input
  std::vector<std::array<double, 3>> weights;  ///< barycentric in it
};

/// Covers the surface of `mesh` with nearly equilateral triangles of one size.
///
/// Rounds of: split edges longer than 4/3 of the target; collapse edges shorter than 4/5; flip
/// edges so that vertices have six neighbours (at last: so that the smallest angle grows); move
/// each vertex in its tangent plane to the mean of the triangles round it, then back to the surface
/// of the input. A vertex finds its foot on the input by walking from its last one from triangle to
/// triangle, so it can't jump to a finger close by. No step makes two surfaces one: adjacency
/// changes by legal edge operations alone, so the Euler number stays, and an operation that would
/// turn a triangle over is left out. Vertices of borders stay; border edges are split only.
///
/// The input should be smooth (subdivide() first) and not much coarser than the result. Sharp edges
/// are rounded by up to half an edge; the rim of a plate thinner than an edge retreats by about
/// one. Vertices come in an order that keeps near ones near in memory. Deterministic. Throws
/// InputError unless the input is 2-manifold, oriented and finite.
///
/// Source: Botsch, Kobbelt 2004, "A remeshing approach to multiresolution modeling", section 4.
RemeshResult remesh(const TriangleMesh& mesh, const RemeshOptions& options = {});

}  // namespace palmar::geometry
