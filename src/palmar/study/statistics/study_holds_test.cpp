// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_holds.h"

#include <gtest/gtest.h>

#include "palmar/study/statistics/study_analysis.h"
#include "palmar/study/statistics/study_test_results.h"

namespace palmar::study {
namespace {

using testing::held;
using testing::not_held;
using testing::study_of;

StudyHold hold_of_part(int part, const std::string& words) {
  StudyHold held;
  held.hold.part = part;
  held.words = words;
  return held;
}

/// Four hands: three by the handle (one of them in vain), one by the body.
StudyResults three_by_the_handle() {
  StudyResults results = study_of(4, {"mug"});
  results.records = {held(0, 0.2), held(1, 0.2), not_held(2, StudyOutcome::kTooLarge),
                     held(3, 0.2)};
  for (const int k : {0, 2, 3}) results.records[k].hold = hold_of_part(2, "wrap of the handle");
  results.records[1].hold = hold_of_part(1, "wrap of the body");
  return results;
}

std::string warning_of_holds(const StudyResults& results) {
  for (const StudyWarning& one : study_warnings(results, {}, {})) {
    if (one.text.find("differ in how they hold it") != std::string::npos) return one.text;
  }
  return "";
}

TEST(StudyHolds, ThatOfMostHandsComesFirst) {
  const StudyResults results = three_by_the_handle();
  const std::vector<HandsByHold> holds = holds_of(results, conditions_of(results.plan).front(), 0);
  ASSERT_EQ(holds.size(), 2U);
  EXPECT_EQ(holds[0].hands, 3);  // who can't hold it so was to, all the same
  EXPECT_EQ(holds[0].hold->hold.part, 2);
  EXPECT_EQ(words_of(holds), "3 hands: wrap of the handle; 1 hand: wrap of the body");
}

TEST(StudyHolds, AWarningSaysThatHandsDiffer) {
  StudyResults results = three_by_the_handle();
  EXPECT_NE(warning_of_holds(results).find("3 hands: wrap of the handle; 1 hand: wrap of the body"),
            std::string::npos);
  results.records[1].hold = results.records[0].hold;
  EXPECT_EQ(warning_of_holds(results), "");
}

TEST(StudyHolds, GraspsThatLackTheThumbAreCounted) {
  StudyResults results = study_of(2, {"bar"});
  results.records = {held(0, 0.2), held(1, 0.2)};
  const auto touch = [](StudyRecord& record, const std::vector<hand::Region>& regions) {
    record.grip = grasp::Grip::kLargeDiameter;
    record.regions.clear();
    for (const hand::Region region : regions) {
      RegionRecord one;
      one.region = region;
      record.regions.push_back(one);
    }
  };
  touch(results.records[0],
        {hand::Region::kThumbDistal, hand::Region::kIndexDistal, hand::Region::kMiddleDistal});
  touch(results.records[1],
        {hand::Region::kThenar, hand::Region::kIndexDistal, hand::Region::kMiddleDistal});
  EXPECT_EQ(hands_with_little(results, conditions_of(results.plan).front(), 0), 1);
}

}  // namespace
}  // namespace palmar::study
