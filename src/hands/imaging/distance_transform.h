// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// One number per voxel, 0 or not: a part of the image.
using VoxelMask = std::vector<std::uint8_t>;

/// Distance of each voxel's centre to the nearest centre of a voxel in `mask`, mm; exact for any
/// spacing; infinite if the mask is empty. In time linear in the voxels: lower envelope of
/// parabolas along each axis in turn (Felzenszwalb, Huttenlocher 2012). The same for any number of
/// threads. Throws UsageError if the mask has another number of values than the grid voxels.
std::vector<float> distance_transform(const VolumeGrid& grid, const VoxelMask& mask);

/// The mask grown or shrunk by a ball of this radius, mm: voxels whose centre is within `radius`
/// of the mask; voxels of the mask farther than `radius` from what is outside of it. The border of
/// the image counts neither as inside nor as outside.
VoxelMask dilated(const VolumeGrid& grid, const VoxelMask& mask, double radius);
VoxelMask eroded(const VolumeGrid& grid, const VoxelMask& mask, double radius);

/// Erosion and then dilation (opening): takes off what is thinner than twice `radius`; and the
/// other way round (closing): fills gaps and pockets thinner than that.
VoxelMask opened(const VolumeGrid& grid, const VoxelMask& mask, double radius);
VoxelMask closed(const VolumeGrid& grid, const VoxelMask& mask, double radius);

}  // namespace palmar::imaging
