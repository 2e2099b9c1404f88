// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "palmar/statistics/summary.h"

namespace palmar::statistics {

/// Student's test of "a and b have the same mean" over the same subjects, d_i = a_i - b_i:
///
///     t = mean(d) / (sd(d) / sqrt(n)),   df = n - 1,   dz = mean(d) / sd(d),
///
/// interval of dz by the non-central t distribution: dz = ncp / sqrt(n), ncp such that t stands at
/// its upper or lower tail. Source: Student 1908; Cohen 1988, section 2.3.5; Steiger & Fouladi
/// 1997. The figures of R's t.test(a, b, paired = TRUE).
struct PairedTest {
  bool is_constant = false;  ///< the differences don't vary: no test is possible, t 0, p 1, dz 0
  int n = 0;                 ///< pairs
  double difference = 0.0;   ///< mean of a - b
  double sd = 0.0;           ///< of the differences
  Interval interval;         ///< of the mean difference
  double t = 0.0;
  double df = 0.0;
  double p_value = 1.0;      ///< two-sided
  double effect_size = 0.0;  ///< Cohen's dz
  Interval effect_interval;  ///< of dz
};

/// Throws UsageError: different lengths, fewer than 2 pairs, a value that is not finite, `level`
/// outside (0, 1).
PairedTest paired_t_test(std::span<const double> a, std::span<const double> b, double level = 0.95);

/// Wilcoxon's signed-rank test of "the differences are symmetric about 0". Differences of 0 are
/// left out; the m others are ranked by magnitude, ties share their mean rank.
///
///     V = sum of the ranks of positive differences,
///     rank-biserial r = (V - V_negative) / (V + V_negative).
///
/// Exact distribution of V for m < 50 without ties and zeros; else normal with mean m (m + 1) / 4,
/// variance m (m + 1)(2 m + 1) / 24 - sum (g^3 - g) / 48 over groups of g ties, and continuity
/// correction 1/2: as R's wilcox.test(a, b, paired = TRUE). The shift is the median of the Walsh
/// averages (d_i + d_j) / 2, i <= j, of the differences that are not 0, and its interval stands
/// between two of them: exact as R's where the test is, by the normal approximation elsewhere (R
/// inverts the test there; the ends differ by less than the step between averages).
/// Source: Wilcoxon 1945; Hollander & Wolfe 1973, sections 3.1 to 3.3; Kerby 2014.
struct SignedRankTest {
  bool is_constant = false;  ///< all differences are 0: p 1
  bool is_exact = false;
  int n = 0;       ///< pairs
  int n_used = 0;  ///< m
  double v = 0.0;
  double p_value = 1.0;                    ///< two-sided
  double rank_biserial = 0.0;              ///< -1 to 1
  double shift = 0.0;                      ///< Hodges-Lehmann estimate of a - b
  std::optional<Interval> shift_interval;  ///< nothing if m is too small for `level`
};

/// Throws UsageError: different lengths, no pair, a value that is not finite, `level` outside
/// (0, 1).
SignedRankTest wilcoxon_signed_rank(std::span<const double> a, std::span<const double> b,
                                    double level = 0.95);

/// p values adjusted for as many tests, in the order given: the i-th smallest of m times m - i + 1,
/// never falling, at most 1. Source: Holm 1979; R's p.adjust(p, "holm"). Throws UsageError if one
/// is outside [0, 1].
std::vector<double> holm(std::span<const double> p_values);

/// Welch's test of "two groups of different people have the same mean": variances may differ.
/// Source: Welch 1947; R's t.test(a, b).
struct WelchTest {
  bool is_constant = false;  ///< neither group varies: no test is possible, t 0, p 1
  double difference = 0.0;   ///< mean(a) - mean(b)
  Interval interval;         ///< of the difference
  double t = 0.0;
  double df = 0.0;  ///< of Welch and Satterthwaite
  double p_value = 1.0;
};
/// Throws UsageError: fewer than 2 values in a group, one that is not finite.
WelchTest welch_t_test(std::span<const double> a, std::span<const double> b, double level = 0.95);

}  // namespace palmar::statistics
