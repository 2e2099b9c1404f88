// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/surface_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "palmar/core/error.h"

namespace palmar::redesign {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(GoalSurface, IsTheMeanFarFromNothingAndNearWhatItWasGiven) {
  Eigen::MatrixXd points(1, 9);
  Eigen::VectorXd values(9);
  for (int i = 0; i < 9; ++i) {
    points(0, i) = i / 8.0;
    values[i] = std::pow(points(0, i) - 0.3, 2);
  }
  const Eigen::VectorXd even = Eigen::VectorXd::Ones(9);
  const GoalSurface surface(points, values, even);
  for (const double x : {0.1, 0.3, 0.55, 0.9}) {
    const auto estimate = surface.at(Eigen::VectorXd::Constant(1, x));
    EXPECT_NEAR(estimate.mean, std::pow(x - 0.3, 2), 0.03) << x;
    EXPECT_GE(estimate.deviation, 0.0);
    EXPECT_LT(estimate.deviation, 0.1);
  }
  EXPECT_THAT([&] { GoalSurface(points, Eigen::VectorXd(3), even); },
              ThrowsMessage<UsageError>(HasSubstr("3 values with 9 of their noise, of 9 points")));
}

TEST(GoalSurface, FollowsARoughValueLessThanTheOthers) {
  // A flat line with one outlier: the surface comes the less near to it the rougher it is.
  Eigen::MatrixXd points(1, 9);
  for (int i = 0; i < 9; ++i) points(0, i) = i / 8.0;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(9), roughness = Eigen::VectorXd::Ones(9);
  values[0] = -0.1;
  values[8] = 0.1;
  values[4] = 1.0;
  const Eigen::VectorXd middle = Eigen::VectorXd::Constant(1, 0.5);
  const double even = GoalSurface(points, values, roughness).at(middle).mean;
  roughness[4] = 100.0;
  EXPECT_LT(GoalSurface(points, values, roughness).at(middle).mean, even);
}

/// Eight variables of 0 to 10, the goal's bowl about `optimum`, and noise of the given deviation
/// that depends on the values alone.
SearchProblem noisy_bowl(const std::vector<double>& optimum, double noise) {
  SearchProblem problem;
  for (std::size_t i = 0; i < optimum.size(); ++i) {
    problem.variables.push_back({"x" + std::to_string(i), "mm", 0.0, 10.0, 5.0, 0.1});
  }
  problem.evaluate = [=](const std::vector<double>& x) {
    double goal = 1.0, seed = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      goal += 0.01 * std::pow(x[i] - optimum[i], 2);
      seed += x[i] * static_cast<double>(i * i + 1);
    }
    std::mt19937 random(static_cast<unsigned>(std::lround(1000.0 * seed)));
    return SearchOutcome{.goal = goal + noise * std::normal_distribution<>()(random),
                         .constraint = {}};
  };
  return problem;
}

TEST(SurfaceSearch, FindsTheValleyOfEightVariablesThroughNoise) {
  const std::vector<double> optimum = {2, 8, 5, 3, 6, 9, 1, 5};
  const SearchProblem problem = noisy_bowl(optimum, 0.05);
  const SearchResult result = search_by_surface(problem, 60, {});
  EXPECT_EQ(result.history.size(), 60U);
  ASSERT_TRUE(result.best);
  const SearchTrial& best = result.history[static_cast<std::size_t>(*result.best)];
  double truth = 1.0;
  for (std::size_t i = 0; i < optimum.size(); ++i) {
    truth += 0.01 * std::pow(best.values[i] - optimum[i], 2);
  }
  // The start's is 1.55, and 2.22 that of a point anywhere, on the mean.
  EXPECT_LT(truth, 1.3);
  ASSERT_TRUE(result.expected);
  EXPECT_NEAR(*result.expected, truth, 0.15);
  // The same problem gives the same history.
  const SearchResult again = search_by_surface(problem, 60, {});
  EXPECT_EQ(again.history.back().values, result.history.back().values);
}

TEST(SurfaceSearch, KeepsToConstraintsAndTriesNothingTwice) {
  SearchProblem problem = noisy_bowl({9, 9}, 0.0);
  problem.constraints = {{"sum", "mm", 12.0, true}};
  const auto goal = problem.evaluate;
  problem.evaluate = [goal](const std::vector<double>& x) {
    SearchOutcome outcome = goal(x);
    outcome.constraint = {x[0] + x[1]};
    return outcome;
  };
  problem.measure = [](const std::vector<double>& x) {
    return SearchOutcome{.constraint = {x[0] + x[1]}};
  };
  const SearchResult result = search_by_surface(problem, 30, {});
  std::set<std::vector<double>> seen;
  for (const SearchTrial& trial : result.history) {
    EXPECT_TRUE(trial.is_feasible);
    EXPECT_TRUE(seen.insert(trial.values).second);
  }
  ASSERT_TRUE(result.best);
  // On the line x + y = 12 nearest to (9, 9): (6, 6), where the goal is 1.18.
  EXPECT_LT(result.history[static_cast<std::size_t>(*result.best)].outcome.goal, 1.22);
}

TEST(SurfaceSearch, WhatWasBrokenOffIsNeverTheBest) {
  SearchProblem problem = noisy_bowl({2, 2}, 0.0);
  const auto goal = problem.evaluate;
  problem.evaluate = [goal](const std::vector<double>& x) {
    SearchOutcome outcome = goal(x);
    if (x[0] < 4.0) outcome.roughness = 3.0;
    return outcome;
  };
  const SearchResult result = search_by_surface(problem, 25, {});
  ASSERT_TRUE(result.best);
  EXPECT_GE(result.history[static_cast<std::size_t>(*result.best)].values[0], 4.0);
}

TEST(SurfaceSearch, WhatCanNotBeMadeIsNeverTheBest) {
  SearchProblem problem = noisy_bowl({2, 2}, 0.0);
  const auto goal = problem.evaluate;
  problem.evaluate = [goal](const std::vector<double>& x) {
    if (x[0] < 4.0) throw NumericalError("too thin");
    return goal(x);
  };
  const SearchResult result = search_by_surface(problem, 25, {});
  ASSERT_TRUE(result.best);
  const SearchTrial& best = result.history[static_cast<std::size_t>(*result.best)];
  EXPECT_GE(best.values[0], 4.0);
  EXPECT_LE(best.outcome.goal, 1.18);  // the start's
}

}  // namespace
}  // namespace palmar::redesign
