// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/hold_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/geometry/degrees.h"
#include "palmar/study/statistics/study_test_results.h"

namespace palmar::workflow {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Three hands hold an original, and a redesign turned by these angles [rad] about `place` and
/// shifted by these vectors [mm] in the hand.
study::StudyResults held_otherwise(const Vec3& place, const std::vector<double>& turns,
                                   const std::vector<Vec3>& shifts) {
  study::StudyResults results =
      testing::study_of(static_cast<int>(turns.size()), {"original", "new"});
  const geometry::Rigid3 before{Quat(Eigen::AngleAxisd(0.4, Vec3::UnitX())), Vec3(3.0, -8.0, 40.0)};
  for (std::size_t h = 0; h < turns.size(); ++h) {
    for (int product = 0; product < 2; ++product) {
      study::StudyTask task;
      task.hand = static_cast<int>(h);
      task.product = product;
      study::StudyRecord record = testing::held(study::number_of(results.plan, task), 0.1);
      record.product_from_hand = before;
      if (product == 1) {
        record.product_from_hand = geometry::Rigid3::about_axis(Vec3::UnitZ(), place, turns[h]) *
                                   before * geometry::Rigid3{Quat::Identity(), -shifts[h]};
      }
      results.records.push_back(record);
    }
  }
  return results;
}

TEST(HoldChange, IsTheMedianTurnAndShiftOverHands) {
  const Vec3 place(5.0, 0.0, 20.0), none = Vec3::Zero();
  const auto changes = hold_changes(
      held_otherwise(place, {2 * geometry::kDegree, 50 * geometry::kDegree, 8 * geometry::kDegree},
                     {none, none, none}),
      place);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].hands, 3);
  EXPECT_EQ(changes[0].redesign, "new");
  EXPECT_NEAR(changes[0].turn / geometry::kDegree, 8.0, 1e-6);
  EXPECT_NEAR(changes[0].largest_turn / geometry::kDegree, 50.0, 1e-6);
  EXPECT_NEAR(changes[0].shift, 0.0, 1e-9);  // turned about the place itself
  EXPECT_FALSE(changes[0].is_other_hold());
  EXPECT_THAT(words_of(changes[0]), Not(HasSubstr("another way")));
}

TEST(HoldChange, WarnsAboveThirtyDegreesOrTenMillimetres) {
  const Vec3 place(0.0, 10.0, 0.0);
  const auto change = [&](double turn, const Vec3& shift) {
    return hold_changes(held_otherwise(place, {turn, turn, turn}, {shift, shift, shift}), place)
        .at(0);
  };
  EXPECT_FALSE(change(29 * geometry::kDegree, Vec3::Zero()).is_other_hold());
  EXPECT_TRUE(change(31 * geometry::kDegree, Vec3::Zero()).is_other_hold());
  EXPECT_FALSE(change(0.0, Vec3(0.0, 9.9, 0.0)).is_other_hold());
  const HoldChange shifted = change(0.0, Vec3(0.0, 0.0, 10.1));
  EXPECT_NEAR(shifted.shift, 10.1, 1e-9);
  EXPECT_TRUE(shifted.is_other_hold());
  EXPECT_THAT(words_of(shifted),
              HasSubstr("it is held in another way, so that a difference may be the hold's"));
}

TEST(HoldChange, CountsOnlyHandsThatHoldBoth) {
  const Vec3 place = Vec3::Zero();
  study::StudyResults results = held_otherwise(place, {0.0, 0.0}, {place, place});
  results.records[1] = testing::not_held(results.records[1].number, study::StudyOutcome::kTooLarge);
  EXPECT_EQ(hold_changes(results, place).at(0).hands, 1);
  results.records[3] = testing::not_held(results.records[3].number, study::StudyOutcome::kSlipsOut);
  EXPECT_EQ(hold_changes(results, place).at(0).hands, 0);
  EXPECT_EQ(words_of(hold_changes(results, place).at(0)), "");
}

}  // namespace
}  // namespace palmar::workflow
