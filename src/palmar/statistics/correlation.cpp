// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "palmar/core/error.h"
#include "palmar/statistics/distributions.h"

namespace palmar::statistics {
namespace {

constexpr double kExact = 1e-14;  // 1 - |r| below this is rounding

void check_pairs(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) {
    throw UsageError("correlation: " + std::to_string(x.size()) + " and " +
                     std::to_string(y.size()) + " values; as many are needed");
  }
  check_sample(x, "correlation, x", 3);
  check_sample(y, "correlation, y", 3);
}

std::vector<double> centred(std::span<const double> values) {
  const double n = static_cast<double>(values.size());
  double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double rest = 0.0;
  for (const double v : values) rest += v - mean;
  mean += rest / n;
  std::vector<double> result;
  for (const double v : values) result.push_back(v - mean);
  return result;
}

/// r, t and p.
Correlation tested(std::span<const double> x, std::span<const double> y) {
  Correlation c;
  c.n = static_cast<int>(x.size());
  c.df = c.n - 2.0;
  if (is_constant(x) || is_constant(y)) {
    c.status = CorrelationStatus::kConstant;
    return c;
  }
  const std::vector<double> dx = centred(x);
  const std::vector<double> dy = centred(y);
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < dx.size(); ++i) {
    xx += dx[i] * dx[i];
    yy += dy[i] * dy[i];
    xy += dx[i] * dy[i];
  }
  c.r = std::clamp(xy / (std::sqrt(xx) * std::sqrt(yy)), -1.0, 1.0);
  if (1.0 - std::abs(c.r) < kExact) {
    c.status = CorrelationStatus::kExact;
    c.r = c.r > 0.0 ? 1.0 : -1.0;
    c.p_value = 0.0;
    return c;
  }
  c.t = c.r * std::sqrt(c.df / ((1.0 - c.r) * (1.0 + c.r)));
  c.p_value = student_two_sided(c.t, c.df);
  return c;
}

/// P of a sum of squared rank differences at least as far out, both sides, over all n! orders.
double exact_spearman(double squares, int n) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const double middle = (std::pow(n, 3) - n) / 6.0;
  const bool is_upper = squares > middle;
  long long count = 0;
  long long all = 0;
  do {
    int sum = 0;
    for (int i = 0; i < n; ++i) {
      const int d = i - order[i];
      sum += d * d;
    }
    if (is_upper ? sum >= squares : sum <= squares) ++count;
    ++all;
  } while (std::next_permutation(order.begin(), order.end()));
  return std::min(1.0, 2.0 * static_cast<double>(count) / static_cast<double>(all));
}

}  // namespace

std::vector<double> mean_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t k = begin; k < end; ++k) {
      ranks[order[k]] = 0.5 * static_cast<double>(begin + 1 + end);
    }
    begin = end;
  }
  return ranks;
}

Correlation pearson(std::span<const double> x, std::span<const double> y, double level) {
  check_level(level);
  check_pairs(x, y);
  Correlation c = tested(x, y);
  if (c.status == CorrelationStatus::kConstant || c.n < 4) return c;
  if (c.status == CorrelationStatus::kExact) {
    c.interval = Interval{c.r, c.r};
    return c;
  }
  const double z = std::atanh(c.r);
  const double half = normal_quantile(0.5 + 0.5 * level) / std::sqrt(c.n - 3.0);
  c.interval = Interval{std::tanh(z - half), std::tanh(z + half)};
  return c;
}

Correlation spearman(std::span<const double> x, std::span<const double> y) {
  check_pairs(x, y);
  const std::vector<double> rx = mean_ranks(x);
  const std::vector<double> ry = mean_ranks(y);
  Correlation c = tested(rx, ry);
  const auto has_ties = [](std::vector<double> ranks) {
    std::sort(ranks.begin(), ranks.end());
    return std::adjacent_find(ranks.begin(), ranks.end()) != ranks.end();
  };
  if (c.n <= 9 && !has_ties(rx) && !has_ties(ry)) {
    double squares = 0.0;
    for (std::size_t i = 0; i < rx.size(); ++i) squares += (rx[i] - ry[i]) * (rx[i] - ry[i]);
    c.p_value = exact_spearman(squares, c.n);
  }
  return c;
}

std::pair<std::vector<double>, std::vector<double>> complete_pairs(
    std::span<const std::optional<double>> x, std::span<const std::optional<double>> y) {
  if (x.size() != y.size()) {
    throw UsageError("pairs of " + std::to_string(x.size()) + " and " + std::to_string(y.size()) +
                     " values; as many are needed");
  }
  std::pair<std::vector<double>, std::vector<double>> result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!x[i] || !y[i]) continue;
    result.first.push_back(*x[i]);
    result.second.push_back(*y[i]);
  }
  return result;
}

}  // namespace palmar::statistics
