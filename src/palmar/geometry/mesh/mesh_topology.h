// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Adjacency of a triangle mesh (corner table).
///
/// Half-edge h = 3 t + k runs from corner k of triangle t to its next corner; it belongs to that
/// triangle. Works for any mesh: open, non-manifold, inconsistently oriented. Triangles that use a
/// vertex twice ("collapsed") have no edges and take no part.
///
/// Source: Rossignac, Safonova, Szymczak 2001, "3D compression made simple: Edgebreaker on a corner
/// table".
struct MeshTopology {
  int vertex_count = 0;
  std::vector<std::array<int, 2>> edge;  ///< end vertices a < b, ascending
  std::vector<int> edge_use;             ///< triangles at each edge: 1 boundary, 2 inner, else > 2
  std::vector<int> edge_of;              ///< 3 per triangle: edge of a half-edge, -1 if collapsed
  /// 3 per triangle: the other half-edge of an edge that exactly two triangles share (whatever
  /// their orientation), else -1.
  std::vector<int> twin;
  std::vector<int> fan_begin;  ///< vertex_count + 1: where the vertex' half-edges begin in `fan`
  std::vector<int> fan;        ///< half-edges that start at a vertex, ascending

  /// Half-edges that start at `vertex`: one per triangle round it.
  std::span<const int> outgoing(int vertex) const {
    return std::span(fan).subspan(fan_begin[vertex], fan_begin[vertex + 1] - fan_begin[vertex]);
  }
  static int next(int half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }
  static int previous(int half_edge) { return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1; }
};

/// Throws InputError if a triangle names a vertex that doesn't exist.
MeshTopology build_topology(const TriangleMesh& mesh);

/// What can be said about a mesh without looking at coordinates.
struct TopologyReport {
  int used_vertices = 0;  ///< vertices that a triangle uses
  int edges = 0;
  int triangles = 0;              ///< without the collapsed ones
  int collapsed_triangles = 0;    ///< a vertex used twice
  int boundary_edges = 0;         ///< one triangle
  int boundary_loops = 0;         ///< connected runs of boundary edges
  int non_manifold_edges = 0;     ///< more than two triangles
  int non_manifold_vertices = 0;  ///< triangles round it are not one fan (bow tie, or worse)
  int inconsistent_edges = 0;     ///< two triangles that disagree about outside
  int components = 0;             ///< connected over shared vertices
  int euler_number = 0;           ///< used vertices - edges + triangles; 2 for a sphere
  bool is_closed = false;         ///< not empty and no boundary edge
  bool is_two_manifold = false;   ///< not empty, no non-manifold edge or vertex, none collapsed
  bool is_oriented = false;       ///< no two neighbours disagree and no edge is non-manifold
};

TopologyReport examine_topology(const TriangleMesh& mesh, const MeshTopology& topology);
TopologyReport examine_topology(const TriangleMesh& mesh);

/// Boundary, non-manifold (more than two triangles) edges as vertex pairs, ascending.
std::vector<std::array<int, 2>> boundary_edges(const MeshTopology& topology);
std::vector<std::array<int, 2>> non_manifold_edges(const MeshTopology& topology);

/// Vertices whose triangles are not one fan joined edge by edge, ascending.
std::vector<int> non_manifold_vertices(const TriangleMesh& mesh, const MeshTopology& topology);

/// Component of each triangle (0, 1, ... in order of the smallest triangle; collapsed: -1). Parts
/// that touch in a vertex are connected.
std::vector<int> triangle_components(const TriangleMesh& mesh, const MeshTopology& topology);

/// Neighbours of each vertex along edges, ascending.
std::vector<std::vector<int>> vertex_neighbours(const MeshTopology& topology);

/// Throws InputError naming `object` and the first fault unless the mesh is closed, 2-manifold and
/// consistently oriented.
void require_closed_manifold(const TriangleMesh& mesh, const std::string& object);

}  // namespace palmar::geometry
