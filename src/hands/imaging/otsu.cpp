// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/otsu.h"

#include <cstddef>

namespace palmar::imaging {

double otsu_threshold(const std::vector<double>& histogram) {
  double total = 0.0, sum = 0.0;
  for (std::size_t b = 0; b < histogram.size(); ++b) {
    total += histogram[b];
    sum += histogram[b] * static_cast<double>(b);
  }
  double below = 0.0, sum_below = 0.0, best = -1.0;
  std::size_t first_best = 0, last_best = 0;
  for (std::size_t b = 0; b + 1 < histogram.size(); ++b) {
    below += histogram[b];
    sum_below += histogram[b] * static_cast<double>(b);
    if (below == 0.0 || below == total) continue;
    const double apart = sum * below - sum_below * total;
    const double between = apart * apart / (below * (total - below));
    if (between > best * (1.0 + 1e-12)) {
      best = between;
      first_best = b;
    }
    if (between >= best * (1.0 - 1e-12)) last_best = b;
  }
  return 0.5 * static_cast<double>(first_best + last_best) + 1.0;
}

}  // namespace palmar::imaging
