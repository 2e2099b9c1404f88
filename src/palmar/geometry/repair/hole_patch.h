// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Whether the corners i and j of a rim are joined by an edge of the mesh outside of the hole.
using IsJoined = std::function<bool(int i, int j)>;

/// A disc over a ring of points: its first vertices are the ring in order, the triangles hold each
/// edge of the ring from i to i + 1. The triangulation of least area for up to 200 corners (cost
/// n^3); for more, up to 2000, ear by ear, the sharpest first. Without `is_joined` edges; empty if
/// there is none. Source: Barequet, Sharir 1995, section 4.
std::optional<TriangleMesh> triangulate_ring(const std::vector<Vec3>& ring,
                                             const IsJoined& is_joined);

/// The patch with long edges split and turned (Delaunay) until they are about as long as those of
/// the ring; the ring stays. At most 20 000 vertices are added.
TriangleMesh refine_patch(const TriangleMesh& patch, int ring_size, const IsJoined& is_joined);

/// The patch with its inner vertices where the surface goes on most smoothly: least sum of squares
/// of the Laplacian over all its vertices (equal weights within, 1 / length on the ring).
/// `beyond[i]` are the neighbours of ring corner i outside of the hole [mm]; with none the patch
/// meets its ring as it likes.
TriangleMesh fair_patch(const TriangleMesh& patch, const std::vector<std::vector<Vec3>>& beyond);

}  // namespace palmar::geometry
