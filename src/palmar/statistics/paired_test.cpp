// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/paired_test.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "palmar/core/error.h"
#include "palmar/statistics/distributions.h"
#include "palmar/statistics/walsh_averages.h"

namespace palmar::statistics {
namespace {

std::vector<double> differences(std::span<const double> a, std::span<const double> b, int fewest) {
  if (a.size() != b.size()) {
    throw UsageError("paired test: " + std::to_string(a.size()) + " and " +
                     std::to_string(b.size()) + " values; as many are needed");
  }
  check_sample(a, "paired test, first sample", fewest);
  check_sample(b, "paired test, second sample", fewest);
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

/// True if a mean of this size hides a standard error by rounding alone; R's t.test refuses then.
bool is_rounding(double standard_error, double magnitude) {
  return standard_error <= 10.0 * 2.220446049250313e-16 * magnitude;
}

double magnitude_of(std::span<const double> values) {
  double largest = 0.0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest;
}

struct SignedRanks {
  double v = 0.0;         ///< sum over positive differences
  double negative = 0.0;  ///< sum over negative ones
  double tie_sum = 0.0;   ///< sum of g^3 - g over groups of ties
};

SignedRanks signed_ranks(const std::vector<double>& d) {
  std::vector<std::size_t> order(d.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return std::abs(d[i]) < std::abs(d[j]); });
  SignedRanks ranks;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && std::abs(d[order[end]]) == std::abs(d[order[begin]])) ++end;
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    const double g = static_cast<double>(end - begin);
    ranks.tie_sum += g * g * g - g;
    for (std::size_t k = begin; k < end; ++k)
      (d[order[k]] > 0.0 ? ranks.v : ranks.negative) += rank;
    begin = end;
  }
  return ranks;
}

/// P(V <= v) for whole v, and the smallest v that reaches p, as R's psignrank and qsignrank.
double exact_lower(const std::vector<double>& counts, double v, int m) {
  double sum = 0.0;
  for (std::size_t s = 0; s < counts.size() && static_cast<double>(s) <= v; ++s) sum += counts[s];
  return std::ldexp(sum, -m);
}

double exact_two_sided(double v, int m) {
  const std::vector<double> counts = signed_rank_counts(m);
  const double last = static_cast<double>(counts.size() - 1);
  // The distribution is symmetric: the upper tail is the lower one of what V lacks.
  const double tail = exact_lower(counts, std::min(v, last - v), m);
  return std::min(1.0, 2.0 * tail);
}

std::uint64_t exact_quantile(double p, int m) {
  const std::vector<double> counts = signed_rank_counts(m);
  double sum = 0.0;
  std::size_t s = 0;
  for (;; ++s) {
    sum += counts[s];
    if (std::ldexp(sum, -m) >= p) break;
  }
  return s;
}

}  // namespace

PairedTest paired_t_test(std::span<const double> a, std::span<const double> b, double level) {
  check_level(level);
  const std::vector<double> d = differences(a, b, 2);
  const Summary s = summarise(d, level);
  PairedTest test;
  test.n = s.n;
  test.difference = s.mean;
  test.sd = s.sd;
  test.df = s.n - 1.0;
  test.interval = *s.mean_interval;
  if (is_rounding(s.standard_error, std::max(magnitude_of(a), magnitude_of(b)))) {
    test.is_constant = true;
    test.sd = 0.0;
    test.interval = {s.mean, s.mean};
    return test;
  }
  const double root = std::sqrt(static_cast<double>(s.n));
  test.t = s.mean / s.standard_error;
  test.p_value = student_two_sided(test.t, test.df);
  test.effect_size = s.mean / s.sd;
  const double tail = 0.5 - 0.5 * level;
  test.effect_interval = {noncentrality_at(test.t, test.df, 1.0 - tail) / root,
                          noncentrality_at(test.t, test.df, tail) / root};
  return test;
}

SignedRankTest wilcoxon_signed_rank(std::span<const double> a, std::span<const double> b,
                                    double level) {
  check_level(level);
  std::vector<double> d = differences(a, b, 1);
  SignedRankTest test;
  test.n = static_cast<int>(d.size());
  std::erase(d, 0.0);
  const int m = static_cast<int>(d.size());
  test.n_used = m;
  if (m == 0) {
    test.is_constant = true;
    return test;
  }
  const SignedRanks ranks = signed_ranks(d);
  test.v = ranks.v;
  test.rank_biserial = (ranks.v - ranks.negative) / (ranks.v + ranks.negative);
  test.is_exact = m < 50 && m == test.n && ranks.tie_sum == 0.0;

  const double count = m;
  const double mean = count * (count + 1.0) / 4.0;
  const double sigma =
      std::sqrt(count * (count + 1.0) * (2.0 * count + 1.0) / 24.0 - ranks.tie_sum / 48.0);
  const double tail = 0.5 - 0.5 * level;
  std::uint64_t below = 0;  // Walsh averages outside the interval at each end, plus one
  if (test.is_exact) {
    test.p_value = exact_two_sided(ranks.v, m);
    below = exact_quantile(tail, m);
    if (below == 0 && std::ldexp(2.0, -m) <= 2.0 * tail) below = 1;
  } else {
    const double offset = ranks.v - mean;
    const double correction = offset > 0.0 ? 0.5 : offset < 0.0 ? -0.5 : 0.0;
    const double z = (offset - correction) / sigma;
    test.p_value = std::min(1.0, 2.0 * normal_cdf(-std::abs(z)));
    const double rank = std::floor(mean + normal_quantile(tail) * sigma);
    below = rank >= 1.0 ? static_cast<std::uint64_t>(rank) : 0;
  }
  std::sort(d.begin(), d.end());
  test.shift = walsh_median(d);
  if (below > 0) {
    const auto size = static_cast<std::uint64_t>(m);
    const std::uint64_t averages = size * (size + 1) / 2;
    test.shift_interval = Interval{walsh_average(d, below), walsh_average(d, averages - below + 1)};
  }
  return test;
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const std::size_t i : order) {
    if (!(p_values[i] >= 0.0 && p_values[i] <= 1.0)) {
      throw UsageError("p value " + std::to_string(i + 1) + " is " + std::to_string(p_values[i]) +
                       "; 0 to 1 is allowed");
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double times = static_cast<double>(order.size() - rank);
    largest = std::max(largest, times * p_values[order[rank]]);
    adjusted[order[rank]] = std::min(1.0, largest);
  }
  return adjusted;
}

WelchTest welch_t_test(std::span<const double> a, std::span<const double> b, double level) {
  check_level(level);
  check_sample(a, "Welch's test, first sample", 2);
  check_sample(b, "Welch's test, second sample", 2);
  const Summary sa = summarise(a, level);
  const Summary sb = summarise(b, level);
  WelchTest test;
  test.difference = sa.mean - sb.mean;
  const double va = sa.standard_error * sa.standard_error;
  const double vb = sb.standard_error * sb.standard_error;
  const double standard_error = std::sqrt(va + vb);
  if (is_rounding(standard_error, std::max(std::abs(sa.mean), std::abs(sb.mean)))) {
    test.is_constant = true;
    test.df = sa.n + sb.n - 2.0;
    test.interval = {test.difference, test.difference};
    return test;
  }
  test.df = (va + vb) * (va + vb) / (va * va / (sa.n - 1.0) + vb * vb / (sb.n - 1.0));
  test.t = test.difference / standard_error;
  test.p_value = student_two_sided(test.t, test.df);
  const double half = student_quantile(0.5 + 0.5 * level, test.df) * standard_error;
  test.interval = {test.difference - half, test.difference + half};
  return test;
}

}  // namespace palmar::statistics
