// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/feature_goal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/study/statistics/study_test_results.h"

namespace palmar::redesign {
namespace {

using ::testing::HasSubstr;
using testing::held;
using testing::not_held;

/// Peaks of the same hands on the original and on a candidate, MPa; 0: not held.
study::StudyResults results_of(const std::vector<std::pair<double, double>>& peaks) {
  study::StudyResults results =
      testing::study_of(static_cast<int>(peaks.size()), {"original", "candidate"});
  for (std::int64_t number = 0; number < study::task_count(results.plan); ++number) {
    const study::StudyTask task = study::task_at(results.plan, number);
    const auto& [first, second] = peaks[task.hand];
    const double peak = task.product == 0 ? first : second;
    results.records.push_back(peak > 0.0 ? held(number, peak)
                                         : not_held(number, study::StudyOutcome::kSlipsOut));
    results.records.back().grip_force = task.product == 0 ? 40.0 : 30.0;
  }
  return results;
}

TEST(FeatureGoal, MeanAndItsErrorAreThoseOfTheHands) {
  const study::StudyResults results = results_of({{0.2, 0.1}, {0.3, 0.2}, {0.4, 0.3}});
  const GoalFigure figure = goal_of(results, feature_goal("peak"), 1);
  EXPECT_NEAR(figure.value, 0.2, 1e-12);
  EXPECT_NEAR(figure.error, 0.1 / std::sqrt(3.0), 1e-12);  // sd 0.1 of three
  EXPECT_NEAR(goal_of(results, feature_goal("peak"), 0).value, 0.3, 1e-12);
  EXPECT_NEAR(mean_ratio(results, "grip_force_n", 1), 0.75, 1e-12);
}

TEST(FeatureGoal, AHandThatLosesHoldCountsAsTheWorstWithTheOriginal) {
  const GoalFigure figure =
      goal_of(results_of({{0.2, 0.1}, {0.5, 0.0}, {0.4, 0.3}}), feature_goal("peak"), 1);
  EXPECT_EQ(figure.hands, 3);
  EXPECT_EQ(figure.lost, 1);
  EXPECT_NEAR(figure.value, (0.1 + 0.5 + 0.3) / 3, 1e-12);
}

TEST(FeatureGoal, HandsThatNeverHeldTheOriginalDoNotCount) {
  const GoalFigure figure = goal_of(results_of({{0.2, 0.1}, {0.0, 0.9}}), feature_goal("peak"), 1);
  EXPECT_EQ(figure.hands, 1);
  EXPECT_NEAR(figure.value, 0.1, 1e-12);
  EXPECT_THROW(goal_of(results_of({{0.0, 0.9}}), feature_goal("peak"), 1), UsageError);
}

TEST(FeatureGoal, SharesAndPercentilesAreOverHands) {
  const study::StudyResults results =
      results_of({{0.2, 0.1}, {0.2, 0.25}, {0.2, 0.35}, {0.2, 0.0}});
  // 0.25 and 0.35 are above 0.2, and the hand that lost hold counts as above, too.
  const GoalFigure share = goal_of(results, feature_goal("peak:above=0.2"), 1);
  EXPECT_NEAR(share.value, 0.75, 1e-12);
  // Type 7 of 0.1, 0.2 (lost), 0.25, 0.35: h = 3 * 0.95 = 2.85.
  EXPECT_NEAR(goal_of(results, feature_goal("peak:p95"), 1).value, 0.25 + 0.85 * 0.1, 1e-12);
}

TEST(FeatureGoal, WordsKnowTheirDirection) {
  EXPECT_TRUE(feature_goal("peak").is_lower_better);
  EXPECT_TRUE(feature_goal("discomfort").is_lower_better);
  EXPECT_FALSE(feature_goal("stability").is_lower_better);
  EXPECT_FALSE(needs_indices(feature_goal("mean")));
  EXPECT_TRUE(needs_indices(feature_goal("stability")));
  EXPECT_EQ(feature_goal("peak_pressure_mpa").unit, "MPa");
  const auto message = [](const std::string& words) {
    try {
      feature_goal(words);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_THAT(message("stabilty"), HasSubstr("did you mean stability"));
  EXPECT_THAT(message("force_n"), HasSubstr("neither better higher nor lower"));
  EXPECT_THAT(message("peak:max"), HasSubstr("p95 or above=NUMBER"));
}

TEST(FeatureGoal, WorseIsWhatIsWorseBeyondChanceInTheSameHands) {
  FeatureGoal goal;
  GoalFigure lead{.value = 1.0, .hands = 4, .values = {1.0, 1.2, 0.8, 1.0}};
  GoalFigure other = lead;
  // Differences 0.1, 0.3, 0.1, 0.3: mean 0.2, deviation 0.1155, t = 0.2 / (0.1155 / 2) = 3.464 with
  // 3 degrees of freedom: p = 0.0203, one-sided.
  other.values = {1.1, 1.5, 0.9, 1.3};
  other.value = 1.2;
  EXPECT_TRUE(is_worse(goal, lead, other, 0.95));
  EXPECT_TRUE(is_worse(goal, lead, other, 0.979));
  EXPECT_FALSE(is_worse(goal, lead, other, 0.981));
  EXPECT_FALSE(is_worse(goal, other, lead, 0.95));
  goal.is_lower_better = false;
  EXPECT_FALSE(is_worse(goal, lead, other, 0.95));
  EXPECT_TRUE(is_worse(goal, other, lead, 0.95));
  EXPECT_FALSE(is_worse(goal, first_of(lead, 1), first_of(other, 1), 0.95));
  EXPECT_NEAR(first_of(other, 2).value, 1.3, 1e-12);
  EXPECT_EQ(first_of(other, 2).hands, 2);
}

}  // namespace
}  // namespace palmar::redesign
