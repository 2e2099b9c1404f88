// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/rank_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "palmar/core/error.h"
#include "palmar/statistics/summary.h"

namespace palmar {

std::vector<double> mean_ranks(std::span<const double> values) {
  const std::size_t n = values.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(n);
  for (std::size_t i = 0; i < n;) {
    std::size_t end = i + 1;
    while (end < n && values[order[end]] == values[order[i]]) ++end;
    const double rank = 0.5 * static_cast<double>(i + 1 + end);  // mean of i + 1 ... end
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = rank;
    i = end;
  }
  return ranks;
}

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) {
    throw UsageError("rank correlation: " + std::to_string(x.size()) + " and " +
                     std::to_string(y.size()) + " values; pairs are required");
  }
  check_sample(x, "rank correlation, x", 2);
  check_sample(y, "rank correlation, y", 2);
  const std::vector<double> a = mean_ranks(x);
  const std::vector<double> b = mean_ranks(y);
  const double middle = 0.5 * static_cast<double>(x.size() + 1);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - middle) * (b[i] - middle);
    aa += (a[i] - middle) * (a[i] - middle);
    bb += (b[i] - middle) * (b[i] - middle);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

}  // namespace palmar
