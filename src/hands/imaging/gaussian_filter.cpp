// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/gaussian_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::imaging {

Volume gaussian_filtered(const Volume& image, double sigma) {
  if (!(sigma >= 0.0) || !std::isfinite(sigma)) {
    throw UsageError("gaussian_filtered: sigma must be 0 or more, mm");
  }
  Volume blurred = image;
  const std::array<std::size_t, 3> size = {static_cast<std::size_t>(image.grid.size[0]),
                                           static_cast<std::size_t>(image.grid.size[1]),
                                           static_cast<std::size_t>(image.grid.size[2])};
  const std::array<std::size_t, 3> stride = {1, size[0], size[0] * size[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double steps = sigma / image.grid.spacing[static_cast<Eigen::Index>(axis)];
    const int reach = static_cast<int>(std::floor(3.0 * steps));
    if (reach < 1) continue;
    std::vector<float> weight(static_cast<std::size_t>(reach) + 1);
    for (std::size_t s = 0; s < weight.size(); ++s) {
      const double x = static_cast<double>(s) / steps;
      weight[s] = static_cast<float>(std::exp(-0.5 * x * x));
    }
    const std::size_t fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
    const int length = image.grid.size[axis];
    parallel_for(static_cast<int>(size[slow]), [&](int task) {
      std::vector<float> line(size[axis]);
      for (std::size_t n = 0; n < size[fast]; ++n) {
        float* values =
            blurred.value.data() + static_cast<std::size_t>(task) * stride[slow] + n * stride[fast];
        for (std::size_t q = 0; q < size[axis]; ++q) line[q] = values[q * stride[axis]];
        for (int q = 0; q < length; ++q) {
          float sum = 0.0F, total = 0.0F;
          for (int p = std::max(0, q - reach); p <= std::min(length - 1, q + reach); ++p) {
            const float w = weight[std::abs(p - q)];
            sum += w * line[p];
            total += w;
          }
          values[static_cast<std::size_t>(q) * stride[axis]] = sum / total;
        }
      }
    });
  }
  return blurred;
}

}  // namespace palmar::imaging
