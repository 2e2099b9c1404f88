// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hands/imaging/distance_transform.h"
#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// What hangs together in a mask.
struct ConnectedParts {
  std::vector<std::int32_t> part;  ///< per voxel: 0, 1, ... by the first voxel; -1 outside the mask
  std::vector<std::size_t> voxels;  ///< per part

  int count() const { return static_cast<int>(voxels.size()); }
  int largest() const;  ///< of equally large ones the first; -1 if there is none
};

enum class Neighbourhood {
  kFaces,    ///< 6 neighbours
  kCorners,  ///< 26 neighbours
};

/// Throws UsageError if the mask has another number of values than the grid voxels.
ConnectedParts connected_parts(const VolumeGrid& grid, const VoxelMask& mask,
                               Neighbourhood neighbourhood = Neighbourhood::kFaces);

/// The voxels of one part.
VoxelMask mask_of(const ConnectedParts& parts, int part);

}  // namespace palmar::imaging
