// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Whether two triangles cross: an edge of one goes through the inside of the other, or both share
/// more than touching. Corners that are equal as points count as one shared corner; triangles that
/// share one corner cross if the edge opposite to it in one goes through the other. Triangles that
/// share an edge, merely touch, or lie in one plane don't cross.
bool do_triangles_cross(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second);

/// Pairs (i, j), i < j, of crossing triangles of one mesh, ascending. Triangles that share a vertex
/// are looked at too, those that share an edge can't cross. Boxes in a tree keep the cost near
/// n log n. Throws InputError on a corner outside the vertex list or a coordinate that isn't
/// finite.
std::vector<std::array<int, 2>> find_self_crossings(const TriangleMesh& mesh);

/// How deep parts of a closed surface poke into each other.
struct CrossingDepth {
  std::vector<std::array<int, 2>> pairs;  ///< crossing triangles, see find_self_crossings()
  std::vector<int> vertex;                ///< vertices inside another part, ascending
  std::vector<double> depth;              ///< of each, mm: distance to the surface that covers it
  double deepest = 0.0;                   ///< largest depth, mm; 0 if nothing crosses
};

/// A vertex is inside another part if the winding number just outside of it is above 1/2. Then its
/// own body and the other overlap behind it, and its depth is the thickness of that overlap there:
/// the shorter of the way along its inward normal to the skin of the overlap (triangles that cross
/// or have a corner inside another part) and the distance to the nearest such triangle of another
/// patch. So two fingers, and the two flanks of a crease, are measured against each other. Vertices
/// are only looked at if any triangles cross. Requires a closed, oriented mesh (else InputError).
CrossingDepth crossing_depth(const TriangleMesh& mesh);

}  // namespace palmar::geometry
