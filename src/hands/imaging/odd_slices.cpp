// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/odd_slices.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/parallel.h"
#include "palmar/statistics/median.h"

namespace palmar::imaging {
namespace {

/// Root mean square of the difference of two slices.
double difference(const Volume& image, int a, int b) {
  const std::size_t plane = image.grid.at(0, 0, 1);
  const float* first = image.value.data() + plane * static_cast<std::size_t>(a);
  const float* second = image.value.data() + plane * static_cast<std::size_t>(b);
  double sum = 0.0;
  for (std::size_t v = 0; v < plane; ++v) {
    const double d = static_cast<double>(first[v]) - static_cast<double>(second[v]);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(plane));
}

}  // namespace

std::vector<OddSlice> odd_slices(const Volume& image) {
  const int slices = image.grid.size[2];
  if (slices < 5) return {};
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  std::vector<double> next(at(slices), 0.0), second(at(slices), 0.0);
  parallel_for(slices, [&](int k) {
    if (k + 1 < slices) next[at(k)] = difference(image, k, k + 1);
    if (k + 2 < slices) second[at(k)] = difference(image, k, k + 2);
  });
  std::vector<OddSlice> all;
  std::vector<double> ratios;
  for (int k = 1; k + 1 < slices; ++k) {
    const double least = std::min(next[at(k - 1)], next[at(k)]), around = second[at(k - 1)];
    if (least <= 0.0) continue;
    // Neighbours that are the same to the bit: an image without noise, or empty margins.
    all.push_back({k, around > 0.0 ? least / around : 1e3});
    ratios.push_back(all.back().ratio);
  }
  if (ratios.empty()) return {};
  const double limit = std::max(1.5, 2.0 * statistics::median(std::move(ratios)));
  std::erase_if(all, [&](const OddSlice& one) { return one.ratio <= limit; });
  return all;
}

}  // namespace palmar::imaging
