// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// One hole of a surface: the free edges round it, as a ring.
struct BoundaryLoop {
  /// Each once, in the order in which triangles that close the hole run along it: the triangle at
  /// the free edge from corner[i] to corner[i + 1] holds that edge the other way round.
  std::vector<int> corner;
  double perimeter = 0.0;      ///< mm
  Vec3 centre = Vec3::Zero();  ///< mean of its edges, mm
  int size() const { return static_cast<int>(corner.size()); }
};

struct BoundaryLoops {
  std::vector<BoundaryLoop> loops;  ///< in order of their smallest corner
  /// Free edges that are part of no ring: neighbours disagree about outside there (see orient.h),
  /// or they end at an edge of more than two triangles.
  int loose_edges = 0;
};

/// The holes of a mesh. Where two holes touch in a corner they are distinguished: a ring passes a
/// corner once. Vertices must be in the list (see build_topology()).
BoundaryLoops find_boundary_loops(const TriangleMesh& mesh, const MeshTopology& topology);

}  // namespace palmar::geometry
