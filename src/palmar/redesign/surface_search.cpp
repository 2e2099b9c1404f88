// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/surface_search.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "palmar/core/error.h"

namespace palmar::redesign {
namespace {

constexpr double kLengths[] = {0.35, 0.7, 1.4};              // of a variable's range
constexpr double kNoises[] = {0.02, 0.06, 0.15, 0.35, 0.7};  // of the values' variance
constexpr double kAlone = 0.65, kTogether = 0.35;            // shares of the covariance; choices
constexpr double kLevel = 1.0;    // variance of the constant, by that of the values
constexpr double kCourage = 1.0;  // deviations by which a place may be better than the surface
constexpr int kPool = 1200, kNearPoints = 400;  // points that are looked at for the next candidate
constexpr double kReach = 0.12;    // standard deviation of those near the best, of the range
constexpr double kCareful = 0.75;  // of the budget; from there on the surface itself decides

double covariance_of(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double length) {
  const auto n = static_cast<double>(a.size());
  const Eigen::ArrayXd squares = (a - b).array().square() / (2.0 * length * length);
  return kLevel + kAlone * (-squares).exp().mean() + kTogether * std::exp(-squares.sum() / n);
}

/// Van der Corput's sequence in a prime base; several bases give Halton's points.
double halton(int index, int base) {
  double value = 0.0, share = 1.0 / base;
  for (; index > 0; index /= base, share /= base) value += share * (index % base);
  return value;
}

Eigen::VectorXd spread_point(int index, int variables) {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  Eigen::VectorXd point(variables);
  for (int i = 0; i < variables; ++i) {
    // Shifted by the golden section, so that large bases don't begin in one corner.
    const double value = halton(index + 1, kPrimes[i % 12]) + 0.618034 * (i + 1);
    point[i] = value - std::floor(value);
  }
  return point;
}

/// What a search by surface keeps.
struct SurfaceSearch {
  const SearchProblem& problem;
  const Progress& progress;
  int budget = 0;
  std::vector<SearchTrial> history = {};
  std::set<SearchSteps> known = {};

  int variables() const { return static_cast<int>(problem.variables.size()); }

  Eigen::VectorXd place_of(const std::vector<double>& values) const {
    const std::vector<double> place = redesign::place_of(problem.variables, values);
    return Eigen::Map<const Eigen::VectorXd>(place.data(), variables());
  }

  /// By what can be said without hands.
  bool may_be_made(const std::vector<double>& values) const {
    if (!problem.measure) return true;
    try {
      const SearchOutcome outcome = problem.measure(values);
      if (!outcome.failure.empty()) return false;
      for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
        if (excess(problem.constraints[i], outcome.constraint.at(i)) > 0.0) return false;
      }
      return true;
    } catch (const NumericalError&) {
      return false;
    }
  }

  /// False if it was made before, or can't be within the constraints.
  bool make(const Eigen::VectorXd& x, bool is_asked_for) {
    progress.throw_if_cancelled();
    const SearchSteps steps =
        steps_at(problem.variables, {x.data(), static_cast<std::size_t>(x.size())});
    if (known.count(steps) > 0) return false;
    const std::vector<double> values = values_at(problem.variables, steps);
    if (!is_asked_for && !may_be_made(values)) return false;
    known.insert(steps);
    progress.update(static_cast<double>(history.size()) / budget,
                    words_of(problem.variables, values));
    history.push_back(try_candidate(problem, values));
    return true;
  }

  bool is_full() const { return static_cast<int>(history.size()) >= budget; }

  /// Lower is better. With what couldn't be made or is beyond a constraint as no better and no
  /// worse than the mean of the others, so that the search keeps away without seeing a cliff; or
  /// without.
  GoalSurface surface(bool with_failures) const {
    const double sign = problem.is_lower_better ? 1.0 : -1.0;
    std::vector<const SearchTrial*> those;
    double mean = 0.0;
    int feasible = 0;
    for (const SearchTrial& trial : history) {
      if (trial.is_feasible) {
        mean += sign * trial.outcome.goal;
        ++feasible;
      }
      if (trial.is_feasible || with_failures) those.push_back(&trial);
    }
    if (feasible > 0) mean /= feasible;
    const auto count = static_cast<Eigen::Index>(those.size());
    Eigen::MatrixXd points(variables(), count);
    Eigen::VectorXd values(count), roughness(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const SearchTrial& trial = *those[static_cast<std::size_t>(i)];
      points.col(i) = place_of(trial.values);
      values[i] = trial.is_feasible ? sign * trial.outcome.goal : mean;
      roughness[i] = trial.outcome.roughness;
    }
    return {points, values, roughness};
  }
  static bool may_be_best(const SearchTrial& trial) {
    return trial.is_feasible && !trial.outcome.is_rough();
  }

  std::optional<int> best(const GoalSurface& surface) const {
    std::optional<int> best;
    double least = 0.0;
    for (std::size_t i = 0; i < history.size(); ++i) {
      if (!may_be_best(history[i])) continue;
      const double mean = surface.at(place_of(history[i].values)).mean;
      if (best && mean >= least) continue;
      best = static_cast<int>(i);
      least = mean;
    }
    return best;
  }

  /// Makes the candidate that promises most; false if none is left.
  bool make_next() {
    const GoalSurface now = surface(true);
    const bool is_careful = static_cast<double>(history.size()) > kCareful * budget;
    const std::optional<int> lead = best(now);
    std::vector<std::pair<double, Eigen::VectorXd>> pool;
    const auto add = [&](const Eigen::VectorXd& x) {
      const GoalSurface::Estimate estimate = now.at(x);
      pool.emplace_back(estimate.mean - (is_careful ? 0.0 : kCourage) * estimate.deviation, x);
    };
    const int from = kPool * static_cast<int>(history.size());
    for (int k = 0; k < kPool; ++k) add(spread_point(from + k, variables()));
    for (int k = 0; lead && k < kNearPoints; ++k) {
      // Sums of twelve evenly spread numbers are normally distributed, about.
      Eigen::VectorXd x = place_of(history[static_cast<std::size_t>(*lead)].values);
      const Eigen::VectorXd a = spread_point(from + 3 * k, variables()),
                            b = spread_point(from + 3 * k + 1, variables()),
                            c = spread_point(from + 3 * k + 2, variables());
      x.array() += 2.0 * kReach * (a + b + c).array() - 3.0 * kReach;
      add(x.cwiseMax(0.0).cwiseMin(1.0));
    }
    std::stable_sort(pool.begin(), pool.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [promise, x] : pool) {
      if (make(x, false)) return true;
    }
    return false;
  }
};

}  // namespace

GoalSurface::GoalSurface(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                         const Eigen::VectorXd& roughness)
    : points_(points) {
  const Eigen::Index n = points.cols();
  if (n < 1 || n != values.size() || n != roughness.size()) {
    throw UsageError(fmt::format("goal surface: {} values with {} of their noise, of {} points",
                                 values.size(), roughness.size(), n));
  }
  mean_ = values.mean();
  const Eigen::VectorXd centred = values.array() - mean_;
  scale_ = n > 1 ? std::sqrt(centred.squaredNorm() / static_cast<double>(n - 1)) : 1.0;
  if (!(scale_ > 0.0)) scale_ = 1.0;
  const Eigen::VectorXd y = centred / scale_;
  double largest = -INFINITY;
  for (const double length : kLengths) {
    Eigen::MatrixXd all(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        all(i, j) = all(j, i) = covariance_of(points.col(i), points.col(j), length);
      }
    }
    for (const double noise : kNoises) {
      Eigen::MatrixXd noisy = all;
      noisy.diagonal() += noise * roughness;
      const Eigen::LLT<Eigen::MatrixXd> factor(noisy);
      const Eigen::VectorXd weights = factor.solve(y);
      const Eigen::MatrixXd lower = factor.matrixL();
      const double likelihood = -0.5 * y.dot(weights) - lower.diagonal().array().log().sum();
      if (!(likelihood > largest)) continue;
      largest = likelihood;
      length_ = length;
      lower_ = lower;
      weights_ = weights;
    }
  }
}

double GoalSurface::covariance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return covariance_of(a, b, length_);
}

GoalSurface::Estimate GoalSurface::at(const Eigen::VectorXd& point) const {
  Eigen::VectorXd to_points(points_.cols());
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    to_points[i] = covariance(point, points_.col(i));
  }
  const Eigen::VectorXd reduced = lower_.triangularView<Eigen::Lower>().solve(to_points);
  const double variance = covariance(point, point) - reduced.squaredNorm();
  return {mean_ + scale_ * to_points.dot(weights_), scale_ * std::sqrt(std::max(0.0, variance))};
}

SearchResult search_by_surface(const SearchProblem& problem, int evaluations,
                               const Progress& progress) {
  SurfaceSearch search{.problem = problem, .progress = progress, .budget = evaluations};
  std::vector<double> start;
  for (const SearchVariable& one : problem.variables) start.push_back(one.start);
  search.make(search.place_of(start), true);
  const int spread = std::min(evaluations, std::max(evaluations / 3, 2 * search.variables()));
  for (int k = 0; static_cast<int>(search.history.size()) < spread && k < 50 * spread; ++k) {
    search.make(spread_point(k, search.variables()), false);
  }
  bool is_left = true;
  while (!search.is_full() && is_left) is_left = search.make_next();
  SearchResult result;
  if (std::any_of(search.history.begin(), search.history.end(), SurfaceSearch::may_be_best)) {
    const GoalSurface surface = search.surface(false);
    result.best = search.best(surface);
    const auto best = static_cast<std::size_t>(result.best.value());
    result.expected = (problem.is_lower_better ? 1.0 : -1.0) *
                      surface.at(search.place_of(search.history[best].values)).mean;
  }
  result.method = "a Gaussian process";
  result.ending = is_left ? "budget spent" : "nothing left to try";
  result.history = std::move(search.history);
  progress.update(1.0, "searched");
  return result;
}

}  // namespace palmar::redesign
