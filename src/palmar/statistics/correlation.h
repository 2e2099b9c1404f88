// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "palmar/statistics/summary.h"

namespace palmar::statistics {

enum class CorrelationStatus {
  kFound,
  kExact,    ///< |r| is 1 but for rounding: t 0, p 0, both ends of the interval at r
  kConstant  ///< one variable doesn't vary: r 0, p 1, no interval
};

/// How two variables go together, and the test of "they don't".
struct Correlation {
  CorrelationStatus status = CorrelationStatus::kFound;
  int n = 0;       ///< pairs
  double r = 0.0;  ///< -1 to 1
  double t = 0.0;
  double df = 0.0;
  double p_value = 1.0;              ///< two-sided
  std::optional<Interval> interval;  ///< of r; needs 4 pairs; Pearson's only
};

/// Pearson's product-moment correlation,
///
///     t = r sqrt((n - 2) / (1 - r^2)),   df = n - 2,
///     interval = tanh(atanh(r) -/+ z / sqrt(n - 3)),
///
/// as R's cor.test(x, y). Source: Pearson 1896; Fisher 1921 (z transformation). Throws UsageError:
/// different lengths, fewer than 3 pairs, a value that is not finite, `level` outside (0, 1).
Correlation pearson(std::span<const double> x, std::span<const double> y, double level = 0.95);

/// Spearman's: Pearson's of the ranks, ties share their mean rank. p exact (all orders counted) for
/// n <= 9 without ties, as R's cor.test(method = "spearman"); else by t with n - 2 degrees of
/// freedom, as with exact = FALSE. Source: Spearman 1904; Kendall 1948, section 4.13.
Correlation spearman(std::span<const double> x, std::span<const double> y);

/// Ranks from 1; ties share their mean rank.
std::vector<double> mean_ranks(std::span<const double> values);

/// The pairs of which neither part is missing, in their order: "pairwise complete".
std::pair<std::vector<double>, std::vector<double>> complete_pairs(
    std::span<const std::optional<double>> x, std::span<const std::optional<double>> y);

}  // namespace palmar::statistics
