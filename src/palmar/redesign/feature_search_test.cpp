// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/feature_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

#include "palmar/core/error.h"

namespace palmar::redesign {
namespace {

using ::testing::HasSubstr;
using Values = std::vector<double>;

SearchVariable variable(const std::string& name, double lowest, double highest, double start,
                        double step = 0.05) {
  return {name, "mm", lowest, highest, start, step};
}

const SearchTrial& best_of(const SearchResult& result) {
  return result.history.at(result.best.value());
}

TEST(SearchFeatures, FindsTheLowestPointOfAParabolaInsideItsBounds) {
  // BOBYQA's quadratic model is exact here; the answer is rounded to the machine's step.
  const SearchProblem problem{.variables = {variable("x", -5, 10, 8), variable("y", 0, 20, 1)},
                              .constraints = {},
                              .evaluate = [](const Values& v) {
                                return SearchOutcome{
                                    .failure = "",
                                    .goal = 3 + std::pow(v[0] - 2, 2) + 2 * std::pow(v[1] - 11, 2),
                                    .constraint = {}};
                              }};
  const SearchResult result = search_features(problem, {.evaluations = 60});
  EXPECT_NEAR(best_of(result).values[0], 2.0, 0.1);
  EXPECT_NEAR(best_of(result).values[1], 11.0, 0.1);
  EXPECT_THAT(result.method, HasSubstr("BOBYQA"));
  EXPECT_LE(result.history.size(), 60U);
}

TEST(SearchFeatures, StopsAtAConstraintThatTheGoalPushesAgainst) {
  // Minimum of -x under (sqrt 2 - 1)(x - 3) <= 3: the fillet whose change is limited to 3 mm,
  // x = 3 + 3 / (sqrt 2 - 1) = 10.243; the largest whole step of 0.05 mm below it is 10.20.
  const double root = std::sqrt(2.0) - 1;
  const SearchProblem problem{.variables = {variable("fillet", 1, 15, 3)},
                              .constraints = {{"largest change", "mm", 3.0, true}},
                              .evaluate = [&](const Values& v) {
                                return SearchOutcome{.failure = "",
                                                     .goal = 100 - v[0],
                                                     .constraint = {root * std::abs(v[0] - 3)}};
                              }};
  const SearchResult result = search_features(problem, {.evaluations = 25});
  EXPECT_NEAR(best_of(result).values[0], 10.20, 0.051);
  EXPECT_LE(best_of(result).outcome.constraint[0], 3.0);
}

TEST(SearchFeatures, SolvesAKnownConstrainedProblem) {
  // Hock & Schittkowski 1981, problem 11: (x - 5)^2 + y^2 - 25 with y >= x^2; the minimum is
  // -8.498464 at (1.23477, 1.52466).
  const SearchProblem problem{
      .variables = {variable("x", -2, 6, 4.9, 0.01), variable("y", -2, 6, 0.1, 0.01)},
      .constraints = {{"y - x^2", "", 0.0, false}},
      .evaluate = [](const Values& v) {
        return SearchOutcome{.failure = "",
                             .goal = std::pow(v[0] - 5, 2) + v[1] * v[1] - 25,
                             .constraint = {v[1] - v[0] * v[0]}};
      }};
  const SearchResult result = search_features(problem, {.evaluations = 150});
  EXPECT_NEAR(best_of(result).outcome.goal, -8.498464, 0.15);
  EXPECT_GE(best_of(result).outcome.constraint[0], 0.0);
}

TEST(SearchFeatures, HigherIsBetterTurnsTheGoalRound) {
  const SearchProblem problem{.variables = {variable("x", 0, 10, 1)},
                              .constraints = {},
                              .is_lower_better = false,
                              .evaluate = [](const Values& v) {
                                return SearchOutcome{.failure = "",
                                                     .goal = 5 - std::pow(v[0] - 7, 2) / 10,
                                                     .constraint = {}};
                              }};
  EXPECT_NEAR(best_of(search_features(problem, {.evaluations = 30})).values[0], 7.0, 0.3);
}

TEST(SearchFeatures, GoesRoundWhatCannotBeMade) {
  // Radii above 8 can't be made; the best one that can is the largest.
  const SearchProblem problem{.variables = {variable("fillet", 1, 15, 3)},
                              .constraints = {},
                              .evaluate = [](const Values& v) -> SearchOutcome {
                                if (v[0] > 8)
                                  throw NumericalError("fillet of " + std::to_string(v[0]));
                                return {.failure = "", .goal = 20 - v[0], .constraint = {}};
                              }};
  const SearchResult result = search_features(problem, {.evaluations = 40});
  EXPECT_NEAR(best_of(result).values[0], 8.0, 0.3);
  int failed = 0;
  for (const SearchTrial& trial : result.history) {
    if (trial.outcome.failure.empty()) continue;
    ++failed;
    EXPECT_FALSE(trial.is_feasible);
    EXPECT_THAT(trial.outcome.failure, HasSubstr("fillet of"));
  }
  EXPECT_GT(failed, 0);
}

TEST(SearchFeatures, NoiseOfHandsMovesTheAnswerLittle) {
  // A wave of 1 % of the goal's range on a parabola.
  const SearchProblem problem{
      .variables = {variable("x", 0, 10, 1), variable("y", 0, 10, 9)},
      .constraints = {},
      .evaluate = [](const Values& v) {
        const double smooth = std::pow(v[0] - 6, 2) + std::pow(v[1] - 4, 2);
        return SearchOutcome{.failure = "",
                             .goal = smooth + 0.5 * std::sin(40 * v[0]) * std::sin(37 * v[1]),
                             .constraint = {}};
      }};
  const SearchResult result = search_features(problem, {.evaluations = 60});
  EXPECT_NEAR(best_of(result).values[0], 6.0, 1.0);
  EXPECT_NEAR(best_of(result).values[1], 4.0, 1.0);
}

TEST(SearchFeatures, DirectFindsTheDeeperOfTwoValleys) {
  // From the start at 1 the nearer valley is at 2; the deeper one is at 8.
  const SearchProblem problem{
      .variables = {variable("x", 0, 10, 1)}, .constraints = {}, .evaluate = [](const Values& v) {
        const double near = std::pow(v[0] - 2, 2);
        const double far = 2 * std::pow(v[0] - 8, 2) - 3;
        return SearchOutcome{.failure = "", .goal = std::min(near, far), .constraint = {}};
      }};
  const SearchResult result =
      search_features(problem, {.method = SearchMethod::kDirect, .evaluations = 40});
  EXPECT_NEAR(best_of(result).values[0], 8.0, 0.3);
}

TEST(SearchFeatures, ALittleHillBesideTheStartDoesNotHideTheValleyBehindIt) {
  // As fillets of the prism feel: nothing changes up to 6, then it gets better; the budget of
  // change ends at 10.2, which is measured without assessing.
  const double root = std::sqrt(2.0) - 1;
  int measured = 0;
  SearchProblem problem{.variables = {variable("fillet", 1, 15, 3)},
                        .constraints = {{"largest change", "mm", 3.0, true}},
                        .evaluate = [&](const Values& v) {
                          const double hill = 0.01 * std::exp(-std::pow(v[0] - 5.5, 2));
                          return SearchOutcome{.failure = "",
                                               .goal = 0.2 + hill - 0.012 * std::max(0.0, v[0] - 6),
                                               .constraint = {root * std::abs(v[0] - 3)}};
                        }};
  problem.measure = [&](const Values& v) {
    ++measured;
    return SearchOutcome{.failure = "", .constraint = {root * std::abs(v[0] - 3)}};
  };
  const SearchResult result = search_features(problem, {.evaluations = 12});
  EXPECT_NEAR(best_of(result).values[0], 10.20, 1e-9);
  for (const SearchTrial& trial : result.history) {
    EXPECT_TRUE(trial.is_feasible) << trial.values[0] << " " << trial.outcome.failure;
  }
  EXPECT_GT(measured, 2);
  EXPECT_LT(measured, 25);
}

TEST(SearchFeatures, MakesNoCandidateTwiceAndNoneOffTheMachinesSteps) {
  std::multiset<Values> made;
  const SearchProblem problem{.variables = {variable("x", 1, 15, 3, 0.5)},
                              .constraints = {},
                              .evaluate = [&](const Values& v) {
                                made.insert(v);
                                return SearchOutcome{
                                    .failure = "", .goal = std::abs(v[0] - 9.1), .constraint = {}};
                              }};
  const SearchResult result = search_features(problem, {.evaluations = 30});
  for (const Values& values : made) {
    EXPECT_EQ(made.count(values), 1U);
    EXPECT_NEAR(std::remainder(values[0] - 1, 0.5), 0.0, 1e-12);
  }
  EXPECT_EQ(best_of(result).values[0], 9.0);
  EXPECT_EQ(result.history.size(), made.size());
  EXPECT_EQ(result.history.front().values[0], 3.0);
}

TEST(SearchFeatures, TheSameProblemGivesTheSameHistory) {
  const SearchProblem problem{.variables = {variable("x", 0, 10, 1), variable("y", 0, 10, 2)},
                              .constraints = {{"sum", "", 12, true}},
                              .evaluate = [](const Values& v) {
                                return SearchOutcome{.failure = "",
                                                     .goal = std::hypot(v[0] - 9, v[1] - 9),
                                                     .constraint = {v[0] + v[1]}};
                              }};
  const SearchResult one = search_features(problem), other = search_features(problem);
  ASSERT_EQ(one.history.size(), other.history.size());
  for (size_t i = 0; i < one.history.size(); ++i) {
    EXPECT_EQ(one.history[i].values, other.history[i].values);
  }
}

TEST(SearchFeatures, WithoutAFeasibleCandidateThereIsNoBest) {
  const SearchProblem problem{.variables = {variable("x", 0, 1, 0)},
                              .constraints = {{"volume", "mm3", 10, false}},
                              .evaluate = [](const Values& v) {
                                return SearchOutcome{
                                    .failure = "", .goal = v[0], .constraint = {5.0}};
                              }};
  EXPECT_FALSE(search_features(problem, {.evaluations = 10}).best.has_value());
}

TEST(SearchFeatures, CancellingAndOtherErrorsComeThrough) {
  std::atomic<bool> cancel = true;
  SearchProblem problem{
      .variables = {variable("x", 0, 1, 0)}, .constraints = {}, .evaluate = [](const Values&) {
        return SearchOutcome{.failure = "", .constraint = {}};
      }};
  Progress progress;
  progress.cancel = &cancel;
  EXPECT_THROW(search_features(problem, {}, progress), Cancelled);
  problem.evaluate = [](const Values&) -> SearchOutcome { throw InputError("gone"); };
  EXPECT_THROW(search_features(problem), InputError);
}

TEST(SearchFeatures, ProblemsThatMakeNoSenseAreReportedByName) {
  const auto message = [](const SearchProblem& problem, const SearchOptions& options) {
    try {
      search_features(problem, options);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  const auto evaluate = [](const Values&) {
    return SearchOutcome{.failure = "", .constraint = {}};
  };
  EXPECT_THAT(message({.variables = {}, .constraints = {}, .evaluate = evaluate}, {}),
              HasSubstr("nothing may vary"));
  EXPECT_THAT(
      message({.variables = {variable("r", 5, 1, 3)}, .constraints = {}, .evaluate = evaluate}, {}),
      HasSubstr("r from 5 to 1"));
  EXPECT_THAT(
      message({.variables = {variable("r", 1, 5, 30)}, .constraints = {}, .evaluate = evaluate},
              {}),
      HasSubstr("r starts at 30"));
  EXPECT_THAT(
      message({.variables = {variable("r", 1, 5, 3, 0)}, .constraints = {}, .evaluate = evaluate},
              {}),
      HasSubstr("steps of 0"));
  EXPECT_THAT(
      message({.variables = {variable("r", 1, 5, 3)}, .constraints = {}, .evaluate = evaluate},
              {.evaluations = 1}),
      HasSubstr("evaluations is 1"));
  EXPECT_THAT(
      message({.variables = {variable("r", 1, 5, 3)}, .constraints = {}, .evaluate = evaluate},
              {.method = SearchMethod::kBobyqa}),
      HasSubstr("two or more variables"));
  EXPECT_THROW(search_method("newton"), UsageError);
}

}  // namespace
}  // namespace palmar::redesign
