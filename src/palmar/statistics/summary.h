// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace palmar::statistics {

/// Two ends, in the unit of what they bound.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Value below which a share p of sorted values lies: linear between order statistics, with
/// h = (n - 1) p (Hyndman & Fan 1996, type 7; R's default). `sorted` ascending and not empty, p in
/// [0, 1]; throws UsageError otherwise.
double quantile(std::span<const double> sorted, double p);

/// A sample in few numbers, in the unit of its values (skewness and kurtosis without unit).
///
///     mean = sum x / n,   sd^2 = sum (x - mean)^2 / (n - 1),   standard_error = sd / sqrt(n),
///     mean_interval = mean -/+ t(1 - (1 - level) / 2; n - 1) standard_error,
///     skewness = sqrt(n (n - 1)) / (n - 2) g1,                          g1 = m3 / m2^1.5,
///     kurtosis = (n - 1) / ((n - 2)(n - 3)) ((n + 1) g2 + 6),            g2 = m4 / m2^2 - 3,
///
/// m_k the central moments sum (x - mean)^k / n. Source: Joanes & Gill 1998 (G1, G2: the figures of
/// SAS and SPSS; 0 of a normal sample).
struct Summary {
  int n = 0;
  double mean = 0.0;
  double sd = 0.0;                        ///< 0 of one value
  double standard_error = 0.0;            ///< of the mean; 0 of one value
  std::optional<Interval> mean_interval;  ///< needs 2 values
  double min = 0.0;
  double lower_quartile = 0.0;
  double median = 0.0;
  double upper_quartile = 0.0;
  double max = 0.0;
  std::optional<double> skewness;         ///< needs 3 values that vary
  std::optional<double> excess_kurtosis;  ///< needs 4 values that vary
};

/// In any order. Throws UsageError if there is no value, one is not finite (by its place), or
/// `level` is outside (0, 1).
Summary summarise(std::span<const double> values, double level = 0.95);

/// Throws UsageError "`what`: value 3 is not finite" and the like; `fewest`: values that are
/// needed.
void check_sample(std::span<const double> values, std::string_view what, int fewest);

/// True if the values differ by no more than rounding: sd <= 1e-13 of the largest magnitude.
bool is_constant(std::span<const double> values);

}  // namespace palmar::statistics
