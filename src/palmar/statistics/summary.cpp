// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/summary.h"

#include <cmath>
#include <string>

#include "palmar/core/error.h"

namespace palmar {

double quantile(std::span<const double> sorted, double p) {
  if (sorted.empty()) throw UsageError("quantile of no values; at least one is needed");
  if (!(p >= 0.0 && p <= 1.0)) {
    throw UsageError("quantile at share " + std::to_string(p) + "; 0 to 1 is allowed");
  }
  const double h = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(h);
  const double rest = h - static_cast<double>(below);
  if (rest == 0.0) return sorted[below];
  return sorted[below] + rest * (sorted[below + 1] - sorted[below]);
}

}  // namespace palmar
