// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/volume.h"

#include <algorithm>
#include <cmath>

namespace palmar::imaging {

float value_at(const Volume& image, const Vec3& voxel) {
  const VolumeGrid& grid = image.grid;
  std::array<int, 3> low{};
  std::array<double, 3> share{};
  for (int a = 0; a < 3; ++a) {
    const double last = grid.size[a] - 1.0;
    if (!(voxel[a] >= 0.0 && voxel[a] <= last)) return 0.0F;
    const double floor = std::min(std::floor(voxel[a]), std::max(0.0, last - 1.0));
    low[a] = static_cast<int>(floor);
    share[a] = voxel[a] - floor;
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<int, 3> at = low;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool is_high = ((corner >> a) & 1) != 0;
      weight *= is_high ? share[a] : 1.0 - share[a];
      at[a] += is_high ? 1 : 0;
    }
    if (weight > 0.0) sum += weight * image.value[grid.at(at[0], at[1], at[2])];
  }
  return static_cast<float>(sum);
}

}  // namespace palmar::imaging
