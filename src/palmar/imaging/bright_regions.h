// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palmar/imaging/distance_transform.h"
#include "palmar/imaging/volume.h"

namespace palmar {

/// Bright regions of an image that dark films part from each other.
struct BrightRegions {
  std::vector<std::int32_t> region;  ///< per voxel: 0, 1, ... by the first voxel; -1 outside
  std::vector<std::size_t> voxels;   ///< per region
  int count() const { return static_cast<int>(voxels.size()); }
};

struct BrightRegionOptions {
  double floor = 0.0;  ///< intensity: darker voxels belong to no region
  double depth = 0.0;  ///< intensity: films shallower than this, in the mean, part nothing
  void check() const;  ///< throws UsageError: not finite, depth below 0
};

/// Parts the brighter voxels of `mask` into regions, even where a film is so thin that partial
/// volume lets single voxels through: a threshold would join the two sides through one such leak.
///
/// 1. Watershed: voxels from bright to dark; each joins the neighbour (of 26) that is brightest, or
///    begins a basin of its own if none is there yet (Vincent, Soille 1991, on the negative image).
/// 2. Two basins A, B that touch are parted by the mean over all pairs of touching voxels (6
///    neighbours) of the darker of the two, m. With L the mean brightness of a basin, the film
///    between them has depth min(L_A, L_B) - m. The pair with the shallowest film is made one as
///    long as that is less than `depth`. The mean, and not the pass as in a hierarchy by dynamics,
///    is what makes a leak of a few voxels harmless.
///
/// Smooth the image first: noise makes basins. Deterministic.
BrightRegions bright_regions(const Volume& image, const VoxelMask& mask,
                             const BrightRegionOptions& options);

}  // namespace palmar
