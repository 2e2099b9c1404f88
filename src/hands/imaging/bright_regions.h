// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/imaging/distance_transform.h"
#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// Bright regions of an image that dark films part from each other.
struct BrightRegions {
  std::vector<std::int32_t> region;  ///< per voxel: 0, 1, ... by the first voxel; -1 outside
  std::vector<std::size_t> voxels;   ///< per region
  int count() const { return static_cast<int>(voxels.size()); }
};

struct BrightRegionOptions {
  double dark = 0.0;    ///< intensity of a film thick enough to be seen as it is
  double floor = 0.0;   ///< intensity: darker voxels belong to no region; at least `dark`
  double core = 0.0;    ///< intensity that a region must have somewhere; at least `floor`
  double depth = 0.25;  ///< films shallower than this part nothing: 1 is as deep as to `dark`
  /// Largest part of a film that may leak: 0.3 lies between the 0.1 to 0.2 that partial volume
  /// opens in a shell of half a voxel's thickness and the half of its section that the marrow of a
  /// slender bone fills.
  double leak = 0.3;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Parts the brighter voxels of `mask` into regions, even where a film is so thin that partial
/// volume lets single voxels through: a threshold would join the two sides through one such leak.
///
/// 1. Watershed: voxels from bright to dark; each joins the brightest neighbour (of 26) that has a
///    basin. A voxel without such a neighbour begins a basin if it is brighter than `core`, else it
///    waits until a basin reaches it (flooding; Vincent, Soille 1991, on the negative image). So
///    two basins meet along the whole of a film, darkest in its middle.
/// 2. Where two basins A, B meet, the darker voxel of each pair of touching voxels (6 neighbours)
///    goes into a histogram; m is the value that a share `leak` of them exceeds. With L the mean
///    brightness of a basin's voxels above `core` and D = `dark`, the film has depth
///    1 - (m - D) / (min(L_A, L_B) - D): what a dim basin is separated by needn't be as dark. The
///    pair with the shallowest film is made one as long as that is less than `depth`. A hierarchy
///    by the pass (dynamics) would join two sides at the first leak.
///
/// Smooth the image first: noise makes basins. Deterministic. Throws UsageError.
BrightRegions bright_regions(const Volume& image, const VoxelMask& mask,
                             const BrightRegionOptions& options);

}  // namespace palmar::imaging
