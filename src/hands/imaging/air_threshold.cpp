// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/air_threshold.h"

#include <algorithm>
#include <vector>

#include "hands/imaging/otsu.h"

namespace palmar::imaging {

double air_threshold(const Volume& image) {
  if (image.value.empty()) return 0.0;
  const auto [least, most] = std::minmax_element(image.value.begin(), image.value.end());
  const double low = *least;
  const double range = static_cast<double>(*most) - low;
  if (!(range > 0.0)) return low;
  constexpr std::size_t kBins = 1024;
  std::vector<double> count(kBins, 0.0);
  const double scale = static_cast<double>(kBins) / range;
  for (const float value : image.value) {
    const auto bin = static_cast<std::size_t>((static_cast<double>(value) - low) * scale);
    count[std::min(bin, kBins - 1)] += 1.0;
  }
  return low + otsu_threshold(count) / scale;
}

}  // namespace palmar::imaging
