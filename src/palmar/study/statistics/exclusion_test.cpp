// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/exclusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/random.h"
#include "palmar/population/built_in_populations.h"

namespace palmar::study {
namespace {

StudyRecord held(double range, double strength, double nails) {
  StudyRecord record;
  record.outcome = StudyOutcome::kHeld;
  record.force = 10.0;
  record.demand = {.range_share = range, .grip_strength = strength, .nail_room = nails};
  return record;
}

StudyRecord not_held(StudyOutcome outcome) {
  StudyRecord record;
  record.outcome = outcome;
  return record;
}

ExclusionCause exclusion(const std::vector<StudyRecord>& records, const Capability& capability,
                         std::size_t own = 0) {
  std::vector<const StudyRecord*> ways;
  for (const StudyRecord& record : records) ways.push_back(&record);
  return exclusion_of(ways, ways[own], capability);
}

TEST(Exclusion, NamesWhatThePersonLacks) {
  const std::vector<StudyRecord> one = {held(0.6, 200.0, 4.0)};
  EXPECT_EQ(exclusion(one, {0.6, 200.0, 4.0}), ExclusionCause::kNone);  // edges count as able
  EXPECT_EQ(exclusion(one, {0.59, 300.0, 0.0}), ExclusionCause::kRange);
  EXPECT_EQ(exclusion(one, {1.0, 199.0, 0.0}), ExclusionCause::kStrength);
  EXPECT_EQ(exclusion(one, {1.0, 300.0, 4.1}), ExclusionCause::kNails);
  EXPECT_EQ(exclusion(one, {1.0, 0.0, 0.0}), ExclusionCause::kNone);  // strength isn't known
  EXPECT_EQ(exclusion(one, {0.1, 1.0, 9.0}), ExclusionCause::kRange);
}

TEST(Exclusion, AnyWayOfHoldingServes) {
  const std::vector<StudyRecord> two = {held(0.9, 100.0, 9.0), held(0.4, 300.0, 9.0)};
  EXPECT_EQ(exclusion(two, {0.5, 350.0, 0.0}), ExclusionCause::kNone);
  EXPECT_EQ(exclusion(two, {1.0, 150.0, 0.0}), ExclusionCause::kNone);
  // Bent enough for the second only, which asks too much strength; the first asks too much range.
  EXPECT_EQ(exclusion(two, {0.5, 150.0, 0.0}), ExclusionCause::kRange);
}

TEST(Exclusion, WhatIsntHeldIsExcludedByWhatHappened) {
  EXPECT_EQ(exclusion({not_held(StudyOutcome::kTooLarge)}, {}), ExclusionCause::kTooLarge);
  EXPECT_EQ(exclusion({not_held(StudyOutcome::kTooSmall)}, {}), ExclusionCause::kTooSmall);
  EXPECT_EQ(exclusion({not_held(StudyOutcome::kSlipsOut)}, {}), ExclusionCause::kSlipsOut);
  EXPECT_EQ(exclusion({not_held(StudyOutcome::kNotGraspable)}, {}), ExclusionCause::kNotGraspable);
  EXPECT_EQ(exclusion({not_held(StudyOutcome::kFailed)}, {}), ExclusionCause::kUnknown);
  // A failure of one's own leaves the answer to the others.
  EXPECT_EQ(exclusion({not_held(StudyOutcome::kFailed), held(0.5, 0.0, 9.0)}, {}),
            ExclusionCause::kNone);
}

std::vector<StudyRecord> random_records(RandomStream& random) {
  std::vector<StudyRecord> records;
  const auto count = 1 + random.below(4);
  for (std::uint64_t k = 0; k < count; ++k) {
    if (random.uniform() < 0.6) {
      const double range = random.uniform(), strength = 400.0 * random.uniform();
      records.push_back(held(range, strength, 10.0 * random.uniform()));
    } else {
      records.push_back(not_held(static_cast<StudyOutcome>(2 + random.below(5))));
    }
  }
  return records;
}

// Less range, less strength or longer nails never include a person whom the abler profile excludes,
// whichever records there are and whichever was found under which profile.
TEST(Exclusion, LessNeverIncludesMore) {
  RandomStream random(7, 0);
  int included = 0;
  for (int k = 0; k < 20000; ++k) {
    const std::vector<StudyRecord> records = random_records(random);
    const Capability able = {random.uniform(), 1.0 + 400.0 * random.uniform(),
                             10.0 * random.uniform()};
    Capability less = able;
    less.range_share *= random.uniform();
    less.grip_strength *= random.uniform();
    less.nail_length += 5.0 * random.uniform();
    const auto own_able = random.below(records.size()), own_less = random.below(records.size());
    const ExclusionCause a = exclusion(records, able, own_able);
    const ExclusionCause b = exclusion(records, less, own_less);
    included += a == ExclusionCause::kNone ? 1 : 0;
    if (b == ExclusionCause::kNone) {
      ASSERT_EQ(a, ExclusionCause::kNone);
    }
    ASSERT_EQ(a == ExclusionCause::kUnknown, b == ExclusionCause::kUnknown);
  }
  EXPECT_GT(included, 1000);  // the law isn't met by excluding everybody
}

// Ten people, one product, three profiles; range reduced, and gloves, whose grasps are others.
StudyResults ten_people() {
  StudyResults results;
  StudyPlan& plan = results.plan;
  plan.name = "ten";
  plan.populations = {{population::population_named("ansur2_women"), {}}};
  plan.profiles = {population::profile_named("none"), population::profile_named("reduced_range"),
                   population::profile_named("thick_gloves")};
  plan.products.resize(1);
  plan.products[0].name = plan.products[0].family = "handle";
  plan.grips = {std::nullopt};
  plan.settings.resize(1);
  for (int k = 0; k < 10; ++k) {
    StudyHand hand;
    hand.sample.label = std::to_string(k);
    hand.sample.grip_strength = 100.0 + 10.0 * k;
    plan.hands.push_back(hand);
  }
  for (std::int64_t number = 0; number < task_count(plan); ++number) {
    const StudyTask task = task_at(plan, number);
    // Whole range: asks 0.1 k of it and 125 N. Reduced range: slips. Gloves: too large for k < 3.
    StudyRecord record = held(0.1 * task.hand, 125.0, 9.0);
    if (task.profile == 1) record = not_held(StudyOutcome::kSlipsOut);
    if (task.profile == 2 && task.hand < 3) record = not_held(StudyOutcome::kTooLarge);
    record.number = number;
    results.records.push_back(record);
  }
  return results;
}

double share_of(const Exclusion& exclusion, ExclusionCause cause) {
  for (const auto& [one, share] : exclusion.causes) {
    if (one == cause) return share.share;
  }
  return 0.0;
}

TEST(Exclusions, CountPeopleByCauseForEveryProfile) {
  const std::vector<Exclusion> list = exclusions(ten_people());
  ASSERT_EQ(list.size(), 3U);
  // As they are: strengths 100, 110, 120 N fall short of 125 N.
  EXPECT_EQ(list[0].excluded.count, 3);
  EXPECT_EQ(list[0].excluded.n, 10);
  EXPECT_DOUBLE_EQ(share_of(list[0], ExclusionCause::kStrength), 0.3);
  // Wilson's interval of 3 in 10 (R: prop.test(3, 10, correct = FALSE)).
  EXPECT_NEAR(list[0].excluded.interval.low, 0.1077913, 1e-6);
  EXPECT_NEAR(list[0].excluded.interval.high, 0.6032219, 1e-6);
  // Range of 0.56: the ways that the whole range found still serve up to k = 5; of those three are
  // too weak, four (6 to 9) too stiff.
  EXPECT_EQ(list[1].excluded.count, 7);
  EXPECT_DOUBLE_EQ(share_of(list[1], ExclusionCause::kRange), 0.4);
  EXPECT_DOUBLE_EQ(share_of(list[1], ExclusionCause::kStrength), 0.3);
  // Gloves: too large for three; 0.71 of the strength is 92.3 ... 134.9 N: 125 N for k = 8, 9 only.
  EXPECT_DOUBLE_EQ(share_of(list[2], ExclusionCause::kTooLarge), 0.3);
  EXPECT_DOUBLE_EQ(share_of(list[2], ExclusionCause::kStrength), 0.5);
  for (const Exclusion& one : list) {
    double sum = 0.0;
    for (const auto& [cause, share] : one.causes) sum += share.share;
    EXPECT_NEAR(sum, one.excluded.share, 1e-12);
    EXPECT_EQ(one.unknown, 0);
  }
}

TEST(Exclusions, GraspsWithoutAnAnswerAreNobodysFault) {
  StudyResults results = ten_people();
  for (StudyRecord& record : results.records) {
    if (task_at(results.plan, record.number).hand == 9) record = not_held(StudyOutcome::kFailed);
  }
  std::int64_t number = 0;
  for (StudyRecord& record : results.records) record.number = number++;
  const Exclusion one = exclusions(results).front();
  EXPECT_EQ(one.unknown, 1);
  EXPECT_EQ(one.excluded.n, 9);
}

}  // namespace
}  // namespace palmar::study
