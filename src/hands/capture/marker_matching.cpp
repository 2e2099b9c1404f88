// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/marker_matching.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/least_cost_pairs.h"

namespace palmar::capture {

void MarkerMatchOptions::check() const {
  const auto require = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
      throw UsageError(fmt::format("matching of markers: {} is {:g} mm; {:g} to {:g} is allowed",
                                   name, value, low, high));
    }
  };
  require("gate", gate, 0.1, 100.0);
  require("last_gate", last_gate, 0.1, gate);
  require("neighbourhood", neighbourhood, 0.1, 1000.0);
}

std::vector<std::optional<int>> assign_points(const std::vector<Vec3>& expected,
                                              const std::vector<Vec3>& found, double gate) {
  std::vector<std::vector<double>> cost(expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (const Vec3& point : found) cost[i].push_back((expected[i] - point).squaredNorm());
  }
  const std::vector<int> pair = least_cost_pairs(cost, gate * gate);
  std::vector<std::optional<int>> match(expected.size());
  for (std::size_t i = 0; i < pair.size(); ++i) {
    if (pair[i] >= 0) match[i] = pair[i];
  }
  return match;
}

std::vector<std::optional<int>> match_markers(const std::vector<Vec3>& expected,
                                              const std::vector<Vec3>& found,
                                              const MarkerMatchOptions& options) {
  options.check();
  std::vector<std::optional<int>> match = assign_points(expected, found, options.gate);
  constexpr int kRounds = 3;
  for (int round = 1; round <= kRounds; ++round) {
    std::vector<Vec3> moved = expected;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      Vec3 sum = Vec3::Zero();
      double weights = 0.0;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        if (k == i || !match[k]) continue;
        const double r = (expected[k] - expected[i]).norm() / options.neighbourhood;
        const double w = std::exp(-0.5 * r * r);
        sum += w * (found[*match[k]] - expected[k]);
        weights += w;
      }
      constexpr double kLeastWeight = 0.05;  // nobody near: as predicted
      if (weights > kLeastWeight) moved[i] += sum / weights;
    }
    const double share = static_cast<double>(round) / kRounds;
    match = assign_points(moved, found,
                          options.gate * std::pow(options.last_gate / options.gate, share));
  }
  return match;
}

}  // namespace palmar::capture
