// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace palmar::product {

/// Squared distance of each voxel of a grid to the nearest one that is set in `feature`, in units
/// of a voxel; exact. `size`: voxels along i, j, k; i runs fastest. Where nothing is set: 1e12.
///
/// Source: Felzenszwalb, Huttenlocher 2012, "Distance transforms of sampled functions", section 2.
std::vector<float> squared_voxel_distance(const std::array<int, 3>& size,
                                          const std::vector<std::uint8_t>& feature);

}  // namespace palmar::product
