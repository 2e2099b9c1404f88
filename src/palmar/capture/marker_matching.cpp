// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/marker_matching.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"

namespace palmar {
namespace {

/// Row of each column of a square cost matrix in the assignment of least cost: shortest augmenting
/// paths with potentials.
std::vector<int> least_assignment(const Eigen::MatrixXd& cost) {
  const auto n = cost.rows();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::vector<int> row_of(static_cast<std::size_t>(n), -1);
  Eigen::VectorXd row_potential = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd column_potential = Eigen::VectorXd::Zero(n);
  for (Eigen::Index start = 0; start < n; ++start) {
    Eigen::VectorXd slack = Eigen::VectorXd::Constant(n, kInfinite);
    std::vector<Eigen::Index> from(static_cast<std::size_t>(n), -1);  // column before
    std::vector<char> is_used(static_cast<std::size_t>(n), 0);
    Eigen::Index row = start, column = -1;
    while (true) {
      Eigen::Index next = -1;
      double least = kInfinite;
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (is_used[k]) continue;
        const double reduced = cost(row, j) - row_potential[row] - column_potential[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          from[k] = column;
        }
        if (slack[j] < least) {
          least = slack[j];
          next = j;
        }
      }
      row_potential[start] += least;
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (is_used[k]) {
          row_potential[row_of[k]] += least;
          column_potential[j] -= least;
        } else {
          slack[j] -= least;
        }
      }
      column = next;
      is_used[static_cast<std::size_t>(column)] = 1;
      if (row_of[static_cast<std::size_t>(column)] < 0) break;
      row = row_of[static_cast<std::size_t>(column)];
    }
    while (column >= 0) {
      const auto k = static_cast<std::size_t>(column);
      const Eigen::Index before = from[k];
      row_of[k] = before < 0 ? static_cast<int>(start) : row_of[static_cast<std::size_t>(before)];
      column = before;
    }
  }
  return row_of;
}

}  // namespace

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
  const auto rows = static_cast<Eigen::Index>(expected.size());
  const auto columns = static_cast<Eigen::Index>(found.size());
  // Each point has a stand-in on the other side to be left alone with.
  const Eigen::Index n = rows + columns;
  const double alone = 0.5 * gate * gate;
  Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(n, n);
  cost.topRightCorner(rows, rows).setConstant(alone);
  cost.bottomLeftCorner(columns, columns).setConstant(alone);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      cost(i, j) = (expected[static_cast<std::size_t>(i)] - found[static_cast<std::size_t>(j)])
                       .squaredNorm();
    }
  }
  const std::vector<int> row_of = least_assignment(cost);
  std::vector<std::optional<int>> match(expected.size());
  for (Eigen::Index j = 0; j < columns; ++j) {
    const int i = row_of[static_cast<std::size_t>(j)];
    if (i < rows) match[static_cast<std::size_t>(i)] = static_cast<int>(j);
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
        sum += w * (found[static_cast<std::size_t>(*match[k])] - expected[k]);
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

}  // namespace palmar
