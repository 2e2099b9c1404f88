// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/summary.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/statistics/distributions.h"

namespace palmar::statistics {

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

void check_sample(std::span<const double> values, std::string_view what, int fewest) {
  if (values.size() < static_cast<std::size_t>(fewest)) {
    throw UsageError(std::string(what) + ": " + std::to_string(values.size()) +
                     (values.size() == 1 ? " value" : " values") + "; at least " +
                     std::to_string(fewest) + (fewest == 1 ? " is needed" : " are needed"));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw UsageError(std::string(what) + ": value " + std::to_string(i + 1) +
                       " is not a finite number");
    }
  }
}

bool is_constant(std::span<const double> values) {
  if (values.empty()) return true;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low <= 1e-13 * std::max(std::abs(*low), std::abs(*high));
}

Summary summarise(std::span<const double> values, double level) {
  check_level(level);
  check_sample(values, "summary", 1);
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  Summary s;
  s.n = static_cast<int>(sorted.size());
  const double n = static_cast<double>(sorted.size());
  double sum = 0.0;
  for (const double x : sorted) sum += x;
  s.mean = sum / n;
  // A second pass takes away what rounding left in the sum, as R does.
  double rest = 0.0;
  for (const double x : sorted) rest += x - s.mean;
  s.mean += rest / n;
  double m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (const double x : sorted) {
    const double d = x - s.mean;
    m2 += d * d;
    m3 += d * d * d;
    m4 += d * d * d * d;
  }
  s.min = sorted.front();
  s.max = sorted.back();
  s.lower_quartile = quantile(sorted, 0.25);
  s.median = quantile(sorted, 0.5);
  s.upper_quartile = quantile(sorted, 0.75);
  if (s.n < 2) return s;
  s.sd = std::sqrt(m2 / (n - 1.0));
  s.standard_error = s.sd / std::sqrt(n);
  const double half = student_quantile(0.5 + 0.5 * level, n - 1.0) * s.standard_error;
  s.mean_interval = Interval{s.mean - half, s.mean + half};
  if (is_constant(sorted)) return s;
  m2 /= n;
  m3 /= n;
  m4 /= n;
  if (s.n > 2) s.skewness = std::sqrt(n * (n - 1.0)) / (n - 2.0) * m3 / std::pow(m2, 1.5);
  if (s.n > 3) {
    s.excess_kurtosis =
        (n - 1.0) / ((n - 2.0) * (n - 3.0)) * ((n + 1.0) * (m4 / (m2 * m2) - 3.0) + 6.0);
  }
  return s;
}

}  // namespace palmar::statistics
