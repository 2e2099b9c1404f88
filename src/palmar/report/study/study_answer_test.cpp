// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/study/statistics/study_statistics.h"

namespace palmar::report {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// A study of hands 160, 162, ... mm long, nothing run yet.
study::StudyResults empty_study(int hands, const std::vector<std::string>& products) {
  study::StudyResults results;
  results.plan.populations.resize(1);
  results.plan.populations.front().population.name = "xie2014";
  results.plan.profiles = {population::HandProfile{}};
  results.plan.settings = {study::StudySetting{}};
  results.plan.grips = {std::nullopt};
  for (int h = 0; h < hands; ++h) {
    study::StudyHand hand;
    hand.sample.dimensions = {{study::kHandLength, 160.0 + 2.0 * h}};
    results.plan.hands.push_back(hand);
  }
  for (const std::string& name : products) {
    study::StudyProduct product;
    product.name = product.family = name;
    results.plan.products.push_back(product);
  }
  return results;
}

study::StudyRecord grasp_of(std::int64_t number, double peak) {
  study::StudyRecord record;
  record.number = number;
  record.outcome = study::StudyOutcome::kHeld;
  record.force = 100.0;
  record.area = 3000.0;
  record.peak_pressure_cells = peak;
  return record;
}

study::StudyRecord failed_grasp(std::int64_t number, study::StudyOutcome outcome) {
  study::StudyRecord record;
  record.number = number;
  record.outcome = outcome;
  return record;
}

/// Hands that hold a and b with these peaks [MPa] and grip forces [N].
study::StudyResults pair_study(const std::vector<double>& a, const std::vector<double>& b,
                               double force_a = 60.0, double force_b = 60.0) {
  study::StudyResults results = empty_study(static_cast<int>(a.size()), {"a", "b"});
  for (study::StudyProduct& product : results.plan.products) product.file = product.name + ".stl";
  for (std::size_t h = 0; h < a.size(); ++h) {
    study::StudyRecord one = grasp_of(static_cast<std::int64_t>(2 * h), a[h]);
    study::StudyRecord other = grasp_of(static_cast<std::int64_t>(2 * h + 1), b[h]);
    one.grip_force = force_a;
    other.grip_force = force_b;
    results.records.push_back(one);
    results.records.push_back(other);
  }
  return results;
}

TEST(StudyAnswer, SaysWhichByHowMuchInHowManyHands) {
  const StudyAnswer answer = study_answer(pair_study({0.40, 0.42, 0.38, 0.41, 0.39, 0.40, 0.30},
                                                     {0.30, 0.31, 0.29, 0.30, 0.28, 0.30, 0.31}));
  // Means 0.3857 and 0.2986: 23 % less; the last hand disagrees.
  EXPECT_EQ(answer.sentence,
            "b presses 23 % less than a at its hardest place, in the same grip of 60 N; 6 of 7 "
            "hands agree; its contact area is about the same.");
  EXPECT_EQ(answer.tone, "good");
  EXPECT_EQ(answer.better, 1);
  ASSERT_EQ(answer.changes.size(), 7U);
  EXPECT_NEAR(answer.changes.front(), -0.25, 1e-12);
  EXPECT_EQ(answer.command, "palmar redesign press b.stl --unit mm --hands 12 --out pressed");
}

TEST(StudyAnswer, IsTheSameWhicheverIsFirst) {
  const StudyAnswer answer = study_answer(pair_study({0.30, 0.31, 0.29, 0.30, 0.28, 0.30, 0.31},
                                                     {0.40, 0.42, 0.38, 0.41, 0.39, 0.40, 0.30}));
  EXPECT_THAT(answer.sentence, HasSubstr("a presses 23 % less than b"));
  EXPECT_THAT(answer.sentence, HasSubstr("6 of 7 hands agree"));
  EXPECT_NEAR(answer.changes.front(), -0.25, 1e-12);
  const std::string interval = answer.reasons.front();
  EXPECT_THAT(interval, HasSubstr("95 % confidence"));
  EXPECT_EQ(interval.find('+'), interval.npos) << interval;
}

TEST(StudyAnswer, SmallButSureDifferencesDontMatter) {
  const StudyAnswer answer = study_answer(
      pair_study({0.40, 0.41, 0.39, 0.40, 0.41, 0.39}, {0.38, 0.389, 0.371, 0.38, 0.39, 0.37}));
  EXPECT_THAT(answer.sentence, HasSubstr("No difference that matters"));
  EXPECT_EQ(answer.tone, "fair");
}

TEST(StudyAnswer, WhatChanceExplainsIsNotShown) {
  const StudyAnswer answer = study_answer(
      pair_study({0.40, 0.20, 0.50, 0.30, 0.45, 0.25}, {0.30, 0.35, 0.28, 0.40, 0.31, 0.30}));
  EXPECT_THAT(answer.sentence, HasSubstr("No difference is shown"));
  EXPECT_THAT(answer.command, HasSubstr("--hands 30"));
}

// Means 0.2967, 0.2983 and 0.40 MPa: c has 35 % more than a, and a and b are alike.
TEST(StudyAnswer, SaysWhatFallsBehindWhereTheBestTwoAreAlike) {
  const std::vector<std::vector<double>> peaks = {{0.30, 0.31, 0.29, 0.30, 0.28, 0.30},
                                                  {0.31, 0.30, 0.30, 0.29, 0.29, 0.30},
                                                  {0.40, 0.42, 0.38, 0.41, 0.39, 0.40}};
  study::StudyResults results = empty_study(6, {"a", "b", "c"});
  for (std::size_t h = 0; h < 6; ++h) {
    for (std::size_t p = 0; p < 3; ++p) {
      study::StudyRecord record = grasp_of(static_cast<std::int64_t>(3 * h + p), peaks[p][h]);
      record.grip_force = 60.0;
      results.records.push_back(record);
    }
  }
  const StudyAnswer answer = study_answer(results);
  EXPECT_EQ(answer.sentence,
            "c presses 35 % more than a (6 of 6 hands agree). Between a and b no difference that "
            "matters is shown.");
  EXPECT_EQ(answer.tone, "good");
  EXPECT_THAT(answer.reasons.front(), HasSubstr("No difference that matters"));
  EXPECT_EQ(answer.worse, 2);  // whose changes are drawn
  EXPECT_NEAR(answer.changes.front(), 0.30 / 0.40 - 1.0, 1e-12);
}

TEST(StudyAnswer, UnequalGripsAreNotCompared) {
  const StudyAnswer answer =
      study_answer(pair_study({0.40, 0.42, 0.41}, {0.20, 0.21, 0.22}, 107.0, 74));
  EXPECT_THAT(answer.sentence, HasSubstr("No verdict yet: hands hold a with 107 N and b with 74"));
  EXPECT_THAT(answer.command, HasSubstr("--grip-force-n 66"));
}

TEST(StudyAnswer, AKeptPostureSaysThatItIsHeldLessFirmly) {
  study::StudyResults results = pair_study({0.40, 0.42, 0.41, 0.40, 0.41, 0.42},
                                           {0.20, 0.21, 0.22, 0.20, 0.21, 0.22}, 107, 74);
  results.plan.products[1].posture_of = "a";
  const StudyAnswer answer = study_answer(
      results, {.language = Language::kEnglish,
                .comparison = {},
                .store = "",
                .command = "palmar redesign press a.stl --unit mm --hands 6 --out pressed"});
  EXPECT_THAT(answer.sentence, HasSubstr("held less firmly: with 74 N instead of 107 N"));
  EXPECT_EQ(
      answer.command,
      "palmar redesign press a.stl --unit mm --hands 6 --hold-posture new --grip-force-n 96 --out "
      "equal");
}

TEST(StudyAnswer, NamesProductsThatNotEveryHandHolds) {
  study::StudyResults results = pair_study({0.4, 0.4, 0.4}, {0.3, 0.3, 0.3});
  results.records[5] = failed_grasp(5, study::StudyOutcome::kTooSmall);
  // Few are named one by one, many are counted.
  EXPECT_THAT(study_answer(results).reasons,
              Contains(HasSubstr("b isn’t held by this hand (too small for the hand): Hand 3")));
  study::StudyResults many =
      pair_study({0.4, 0.4, 0.4, 0.4, 0.4, 0.4}, {0.3, 0.3, 0.3, 0.3, 0.3, 0.3});
  for (const int k : {1, 3, 5, 7}) {
    many.records[static_cast<std::size_t>(k)] = failed_grasp(k, study::StudyOutcome::kTooSmall);
  }
  EXPECT_THAT(study_answer(many).reasons, Contains("b is held by 2 of 6 hands."));
  results.records[1] = failed_grasp(1, study::StudyOutcome::kTooSmall);
  EXPECT_THAT(study_answer(results).sentence, HasSubstr("No verdict: too few hands hold both"));
}

TEST(StudyAnswer, OfOneProductSaysWhatHandsFeel) {
  study::StudyResults results = empty_study(2, {"a"});
  results.records = {grasp_of(0, 0.2), grasp_of(1, 0.4)};
  EXPECT_THAT(study_answer(results).sentence,
              HasSubstr("2 of 2 hands hold a; the highest pressure is "
                        "0.30 MPa on average, 0.20 to 0.40 MPa"));
  results.records = {failed_grasp(0, study::StudyOutcome::kTooLarge)};
  EXPECT_EQ(study_answer(results).sentence, "No hand holds a.");
}

study::StudyResults one_product_with_comfort(double discomfort_percent) {
  study::StudyResults results = empty_study(3, {"a"});
  results.plan.products.front().file = "a.stl";
  for (int h = 0; h < 3; ++h) {
    study::StudyRecord record = grasp_of(h, 0.1);
    record.indices = {{"pain_onset_percent", h == 0 ? 100.0 : 40.0},
                      {"discomfort_onset_percent", h < 2 ? discomfort_percent : 50.0},
                      {"skin_above_50_kpa_percent", 10.0 * h}};
    results.records.push_back(record);
  }
  return results;
}

TEST(StudyAnswer, SaysInHowManyHandsItHurtsOrIsUncomfortable) {
  const StudyAnswer answer = study_answer(one_product_with_comfort(120.0));
  EXPECT_THAT(answer.reasons, Contains("A moment of this grip hurts 1 of 3 hands; repeated, it "
                                       "becomes uncomfortable for 2 of 3 hands; held for minutes "
                                       "without a break, it stops the blood in 10 % of the touched "
                                       "skin (mean)."));
  EXPECT_EQ(answer.command, "palmar redesign press a.stl --unit mm --hands 12 --out pressed");
}

TEST(StudyAnswer, AFewHandsThatAllAgreeShowNothing) {
  // Means 0.41 and 0.295: 28 % less.
  EXPECT_EQ(study_answer(pair_study({0.40, 0.42}, {0.30, 0.29})).sentence,
            "No difference is shown: b presses 28 % less than a on average, and all 2 hands agree, "
            "but so few may do so by chance.");
}

TEST(StudyAnswer, AMadeProductIsRedesignedByItsWords) {
  study::StudyResults results = one_product_with_comfort(120.0);
  results.plan.products.front().file = "made: prism width_mm=40";
  EXPECT_EQ(study_answer(results).command,
            "palmar redesign press 'made: prism width_mm=40' --hands 12 --out pressed");
}

TEST(StudyAnswer, WhereNobodyIsUncomfortableNothingIsPressed) {
  StudyAnswerOptions options;
  options.store = "a.palmar";
  const StudyAnswer answer = study_answer(one_product_with_comfort(60.0), options);
  EXPECT_EQ(answer.command, "palmar study report a.palmar --out report");
}

}  // namespace
}  // namespace palmar::report
