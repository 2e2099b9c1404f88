// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/tissue_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/statistics/median.h"

namespace palmar::imaging {

double tissue_noise(const Volume& image, const std::vector<float>& depth, double deeper) {
  constexpr double kNormal = 1.4826;  // standard deviation over median of the absolute value
  const auto& size = image.grid.size;
  const std::array<std::size_t, 3> stride = {
      1, static_cast<std::size_t>(size[0]),
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])};
  double least = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> residual;
    for (int k = axis == 2 ? 1 : 0; k < size[2] - (axis == 2 ? 1 : 0); ++k) {
      for (int j = axis == 1 ? 1 : 0; j < size[1] - (axis == 1 ? 1 : 0); ++j) {
        for (int i = axis == 0 ? 1 : 0; i < size[0] - (axis == 0 ? 1 : 0); ++i) {
          const std::size_t v = image.grid.at(i, j, k);
          if (static_cast<double>(depth[v]) <= deeper) continue;
          const float around = image.value[v - stride[axis]] + image.value[v + stride[axis]];
          residual.push_back(std::abs(image.value[v] - 0.5F * around));
        }
      }
    }
    if (residual.empty()) return 0.0;
    const double here =
        kNormal * static_cast<double>(statistics::median(std::move(residual))) / std::sqrt(1.5);
    least = axis == 0 ? here : std::min(least, here);
  }
  return least;
}

}  // namespace palmar::imaging
