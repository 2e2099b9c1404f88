// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/imaging/distance_transform.h"
#include "hands/imaging/volume.h"
#include "palmar/geometry/types.h"

namespace palmar::imaging {

/// Grows a body without handles and holes within a mask: from the voxel with the largest `order`
/// always by the voxel of the mask next to it with the largest `order` that is simple (is_simple),
/// until there is none. Where two arms of the mask meet, a film one voxel thick parts them, at the
/// place where `order` is least along their way; with the depth below the surface for `order` that
/// is where two fingers touch least. A bubble within gets a channel to the outside: fill those
/// beforehand.
///
/// `order`: one per voxel. The border of the image counts as outside. Deterministic. Empty for an
/// empty mask. Throws UsageError for another number of values than voxels.
VoxelMask simple_body(const VolumeGrid& grid, const VoxelMask& mask,
                      const std::vector<float>& order);

/// Whether the middle one of 27 voxels can join or leave the body without a change of topology:
/// among its neighbours there is exactly one part of the body and one of the outside next to it
/// (Bertrand, Malandain 1994: topological numbers for 6+ neighbours of the body and 18 of the
/// outside). Bit i + 3 j + 9 k of `around` says whether neighbour (i, j, k), 0 to 2 each, is body;
/// bit 13 is ignored.
bool is_simple(std::uint32_t around);

/// A surface and what it took to make it one.
struct SimpleSurface {
  geometry::TriangleMesh mesh;
  int handles = 0;  ///< that were cut through, 0 if there were none
};

/// iso_surface() round the largest body of `image` above `level`, without handles and holes: a
/// topological sphere (Euler number 2). Bubbles are filled, handles cut by simple_body() where they
/// are thinnest. Voxels that this takes to the other side of the level are put a twentieth of
/// `contrast` beyond it. Empty if nothing is brighter.
SimpleSurface simple_surface(Volume image, double level, double contrast);

}  // namespace palmar::imaging
