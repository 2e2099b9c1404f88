// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/solid_grid.h"

namespace palmar::product {

/// A line of a skeleton from node to node, in the grid's frame.
struct SkeletonEdge {
  std::array<int, 2> node = {-1, -1};  ///< -1 at both ends: a ring of its own
  std::vector<Vec3> point;             ///< about a voxel apart, ends included; mm
  std::vector<double> radius;          ///< depth of the solid at each point, mm
};

/// Centre lines of a solid: as many rings as it has tunnels, and a line to every tip.
struct SkeletonGraph {
  std::vector<Vec3> node;           ///< grid's frame, mm
  std::vector<double> node_radius;  ///< mm; 0: dropped, no line ends there
  std::vector<SkeletonEdge> edges;
};

/// Whether a voxel can leave a solid without a change of topology (26 neighbours for the solid, 6
/// for air). Bit i + 3 j + 9 k of `around` says whether neighbour (i, j, k), 0 to 2 each, is solid.
/// Source: Bertrand, Malandain 1994, topological numbers.
bool can_leave(std::uint32_t around);

/// Finds the tips first: from the deepest voxel on, again and again the voxel farthest from what
/// the lines so far reach with 1.6 times their depth (Sato et al. 2000, TEASAR: that spares the
/// corners of a flat end). Then takes away voxels from the shallowest on as long as neither
/// topology nor tips are lost (homotopic thinning, Couprie, Coeurjolly, Zrour 2007), so that the
/// rings are those of the solid. Lines to tips are dropped that keep their depth over less than a
/// finger's breadth and don't become thicker again: corners, edges, flat ends, but no knob.
/// Deterministic.
SkeletonGraph skeleton_of(const SolidGrid& grid);

}  // namespace palmar::product
