// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/imaging/air_threshold.h"

#include <algorithm>
#include <array>

namespace palmar {

double air_threshold(const Volume& image) {
  if (image.value.empty()) return 0.0;
  const auto [least, most] = std::minmax_element(image.value.begin(), image.value.end());
  const double low = *least;
  const double range = static_cast<double>(*most) - low;
  if (!(range > 0.0)) return low;
  constexpr std::size_t kBins = 1024;
  std::array<double, kBins> count{};
  const double scale = static_cast<double>(kBins) / range;
  double total = 0.0;
  double sum = 0.0;
  for (const float value : image.value) {
    const auto bin = static_cast<std::size_t>((static_cast<double>(value) - low) * scale);
    count[std::min(bin, kBins - 1)] += 1.0;
  }
  for (std::size_t b = 0; b < kBins; ++b) {
    total += count[b];
    sum += count[b] * static_cast<double>(b);
  }
  double below = 0.0;
  double sum_below = 0.0;
  double best = -1.0;
  std::size_t first_best = 0;
  std::size_t last_best = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    below += count[b];
    sum_below += count[b] * static_cast<double>(b);
    if (below == 0.0 || below == total) continue;
    const double apart = sum * below - sum_below * total;
    const double between = apart * apart / (below * (total - below));
    if (between > best * (1.0 + 1e-12)) {
      best = between;
      first_best = b;
    }
    if (between >= best * (1.0 - 1e-12)) last_best = b;
  }
  // Where empty bins lie between the classes, their middle.
  const double bin = 0.5 * static_cast<double>(first_best + last_best) + 1.0;
  return low + bin / scale;
}

}  // namespace palmar
