// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Whether the triangle with these corners [mm] is to be refined.
using TriangleChoice = std::function<bool(const Vec3&, const Vec3&, const Vec3&)>;

/// A refined mesh and where its triangles come from.
struct SplitMesh {
  TriangleMesh mesh;
  std::vector<int> parent;  ///< per triangle: that of the input it is a part of
};

/// The mesh with edges longer than `edge_length` [mm] split at their middles, round by round and in
/// every triangle its long edges first, so that needles get rounder. The surface is the same; the
/// first vertices are those of the input, in order; neighbours are split together, so a closed mesh
/// stays closed. With `where` only the long edges of chosen triangles are split. Deterministic.
/// Throws UsageError unless 0.1 <= edge_length <= 1000, InputError on a corner outside the vertex
/// list.
SplitMesh split_with_parents(const TriangleMesh& mesh, double edge_length,
                             const TriangleChoice& where = {});
/// The mesh alone.
TriangleMesh split_long_edges(const TriangleMesh& mesh, double edge_length,
                              const TriangleChoice& where = {});

}  // namespace palmar::geometry
