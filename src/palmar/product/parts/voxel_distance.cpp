// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/voxel_distance.h"

#include <algorithm>
#include <cstddef>

#include "palmar/core/parallel.h"

namespace palmar::product {
namespace {

constexpr float kFar = 1e12F;

// Lower envelope of the parabolas value[q] + (x - q)^2 at x = 0, 1, ...; `apex` and `from` are
// memory for the parabolas on it.
void transform_line(const std::vector<float>& value, std::vector<float>& result,
                    std::vector<int>& apex, std::vector<double>& from) {
  const int n = static_cast<int>(value.size());
  int last = -1;
  for (int q = 0; q < n; ++q) {
    if (value[q] >= kFar) continue;
    double start = -1.0;
    while (last >= 0) {
      const int p = apex[last];
      start = ((static_cast<double>(value[q]) + static_cast<double>(q) * q) -
               (static_cast<double>(value[p]) + static_cast<double>(p) * p)) /
              (2.0 * (q - p));
      if (start > from[last]) break;
      --last;
    }
    ++last;
    apex[last] = q;
    from[last] = last == 0 ? -1.0 : start;
  }
  if (last < 0) {
    std::fill(result.begin(), result.end(), kFar);
    return;
  }
  int k = 0;
  for (int x = 0; x < n; ++x) {
    while (k < last && from[k + 1] < x) ++k;
    const auto d = static_cast<float>(x - apex[k]);
    result[x] = value[apex[k]] + d * d;
  }
}

}  // namespace

std::vector<float> squared_voxel_distance(const std::array<int, 3>& size,
                                          const std::vector<std::uint8_t>& feature) {
  std::vector<float> field(feature.size());
  for (std::size_t i = 0; i < field.size(); ++i) field[i] = feature[i] != 0 ? 0.0F : kFar;
  const std::array<std::size_t, 3> stride = {1, static_cast<std::size_t>(size[0]),
                                             static_cast<std::size_t>(size[0]) * size[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = axis == 0 ? 1 : 0;
    const std::size_t v = axis == 2 ? 1 : 2;
    const int n = size[axis];
    parallel_for(size[v], [&](int b) {
      std::vector<float> line(n), result(n);
      std::vector<int> apex(n);
      std::vector<double> from(n);
      for (int a = 0; a < size[u]; ++a) {
        const std::size_t base = a * stride[u] + b * stride[v];
        for (int x = 0; x < n; ++x) line[x] = field[base + x * stride[axis]];
        transform_line(line, result, apex, from);
        for (int x = 0; x < n; ++x) field[base + x * stride[axis]] = result[x];
      }
    });
  }
  return field;
}

}  // namespace palmar::product
