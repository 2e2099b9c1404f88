// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/verdict.h"

#include <gtest/gtest.h>

#include "palmar/grasp/task_force.h"

namespace palmar::study {
namespace {

/// A wrap at rest with that grip force and peak on sensor cells at the thenar.
AssessedProduct held(const std::string& name, double grip_force, double peak) {
  AssessedProduct one;
  one.product.name = name;
  Assessment& assessment = one.assessment;
  assessment.grasp.status = grasp::GraspStatus::kHeld;
  assessment.grasp.grip = grasp::Grip::kMediumWrap;
  assessment.balance.status = grasp::BalanceStatus::kBalanced;
  assessment.balance.grip_force = grip_force;
  for (const hand::Region region :
       {hand::Region::kThumbDistal, hand::Region::kIndexDistal, hand::Region::kMiddleDistal,
        hand::Region::kCentralPalm, hand::Region::kThenar}) {
    contact::RegionContact contact;
    contact.region = region;
    contact.peak_pressure_cells = region == hand::Region::kThenar ? peak : 0.5 * peak;
    assessment.contact.regions.push_back(contact);
  }
  assessment.contact.total.peak_pressure_cells = peak;
  assessment.contact.total.area = 1000.0;
  return one;
}

void add_band(AssessedProduct& one, double soft, double stiff) {
  contact::ContactBand band;
  band.total.peak_pressure_cells_low = soft;
  band.total.peak_pressure_cells_high = stiff;
  one.assessment.contact.band = band;
}

SetVerdict verdict_on(std::vector<AssessedProduct> products) {
  return verdict_of({.hand = nullptr, .assessments = std::move(products), .command_line = ""});
}

TEST(SetVerdict, OfTwoTheOneThatPressesLessIsBest) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 61, 0.29)};
  two[1].assessment.contact.total.area = 1120.0;
  const SetVerdict verdict = verdict_on(two);
  ASSERT_EQ(verdict.comparisons.size(), 1U);
  EXPECT_EQ(verdict.comparisons[0].verdict, PairVerdict::kLower);
  EXPECT_EQ(verdict.best, 1);
  EXPECT_EQ(verdict.comparisons[0].worse, 0);
  EXPECT_NEAR(verdict.comparisons[0].peak_change, -0.275, 1e-12);
  EXPECT_NEAR(verdict.comparisons[0].area_change, 0.12, 1e-12);
  EXPECT_EQ(verdict.products[1].hardest->region, hand::Region::kThenar);
}

TEST(SetVerdict, WhatCantBeToldApartIsNoDifference) {
  EXPECT_EQ(verdict_on({held("a", 60, 0.40), held("b", 60, 0.37)}).comparisons[0].verdict,
            PairVerdict::kSame);
  EXPECT_FALSE(verdict_on({held("a", 60, 0.40), held("b", 60, 0.37)}).best);
}

TEST(SetVerdict, ADifferenceThatDependsOnTheSkinIsNone) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.30)};
  add_band(two[0], 0.20, 0.60);
  add_band(two[1], 0.15, 0.45);
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kLower);
  EXPECT_NEAR(*verdict_on(two).comparisons[0].peak_change_soft, -0.25, 1e-12);
  add_band(two[1], 0.25, 0.45);  // harder than a with soft skin
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kDependsOnSkin);
  EXPECT_FALSE(verdict_on(two).best);
}

TEST(SetVerdict, ADifferenceThatASlightlyOtherHandMayMakeIsNone) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.34)};  // 15 % less
  for (AssessedProduct& one : two) one.assessment.certainty.emplace();
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kLower);
  two[0].assessment.certainty->hand_size.peak_pressure_cells = -0.12;
  two[1].assessment.certainty->grip_force.peak_pressure_cells = 0.16;
  EXPECT_NEAR(*verdict_on(two).comparisons[0].peak_unsure, 0.2, 1e-12);
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kSame);
  EXPECT_FALSE(verdict_on(two).best);
}

TEST(SetVerdict, ADifferenceThatASecondRestReversesIsNone) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.30)};
  for (AssessedProduct& one : two) one.assessment.certainty.emplace();
  two[0].assessment.certainty->second = {.change = {.peak_pressure_cells = -0.2}, .effort = 1.01};
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kLower);  // 0.32 and 0.30
  EXPECT_NEAR(*verdict_on(two).comparisons[0].peak_change_second, -0.0625, 1e-12);
  two[1].assessment.certainty->second = {.change = {.peak_pressure_cells = 0.5}, .effort = 1.03};
  EXPECT_NEAR(*verdict_on(two).comparisons[0].peak_change_second, 0.125, 1e-12);  // 0.40 and 0.45
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kDependsOnRest);
  EXPECT_FALSE(verdict_on(two).best);
}

TEST(SetVerdict, SaysHowFarTheHandLiesOtherwise) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.30)};
  EXPECT_TRUE(verdict_on(two).comparisons[0].are_held_alike());
  grasp::Grasp& grasp = two[1].assessment.grasp;
  // Thicker handles keep the hand's middle on their axis, while the hand itself moves.
  grasp.product_from_hand.translation = Vec3(0.0, 0.0, 30.0);
  EXPECT_TRUE(verdict_on(two).comparisons[0].are_held_alike());
  grasp.product_from_hand.rotation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
  grasp.grip_point = Vec3(3.0, 0.0, 4.0);
  EXPECT_NEAR(*verdict_on(two).comparisons[0].hand_turned, 0.3, 1e-9);
  EXPECT_NEAR(*verdict_on(two).comparisons[0].hand_shifted, 5.0, 1e-9);
  EXPECT_FALSE(verdict_on(two).comparisons[0].are_held_alike());  // 17 degrees
  grasp.product_from_hand.rotation = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitY()));
  EXPECT_TRUE(verdict_on(two).comparisons[0].are_held_alike());
  grasp.grip_point = Vec3(3.0, 0.0, 4.1);
  EXPECT_FALSE(verdict_on(two).comparisons[0].are_held_alike());
  EXPECT_EQ(verdict_on(two).best, 1);  // still the one that presses less, as it is held
  two[0].assessment.contact.regions.clear();
  EXPECT_FALSE(verdict_on(two).comparisons[0].hand_turned);
}

TEST(SetVerdict, TheMiddleOfAPinchIsBetweenThumbAndFingers) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.30)};
  for (AssessedProduct& one : two) {
    grasp::Grasp& grasp = one.assessment.grasp;
    grasp.grip = grasp::Grip::kTripod;
    grasp.fingertips.resize(3);
    for (int f = 0; f < 3; ++f) {
      grasp.fingertips[f].finger = static_cast<hand::Finger>(f);
      grasp.fingertips[f].reached = Vec3(f == 0 ? 20.0 : -20.0, 10.0 * f, 0.0);
    }
  }
  // The fingers move by 12 mm, the middle by half of that.
  two[1].assessment.grasp.fingertips[1].reached += Vec3(0.0, 12.0, 0.0);
  two[1].assessment.grasp.fingertips[2].reached += Vec3(0.0, 12.0, 0.0);
  EXPECT_NEAR(*verdict_on(two).comparisons[0].hand_shifted, 6.0, 1e-9);
}

TEST(SetVerdict, PressuresOfUnequalGripsAreNotCompared) {
  const SetVerdict verdict = verdict_on({held("a", 107, 0.40), held("b", 86, 0.20)});
  EXPECT_EQ(verdict.comparisons[0].verdict, PairVerdict::kUnequalForce);
  EXPECT_FALSE(verdict.best);
}

TEST(SetVerdict, WhatSlipsOutIsNotBetter) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.10)};
  two[1].assessment.balance.status = grasp::BalanceStatus::kSlipsOut;
  const SetVerdict verdict = verdict_on(two);
  EXPECT_EQ(verdict.products[1].held, HeldVerdict::kDoubtful);
  EXPECT_EQ(verdict.comparisons[0].verdict, PairVerdict::kOnlyOneHeld);
  EXPECT_EQ(verdict.best, 0);
  two[0].assessment.contact.regions.clear();
  EXPECT_EQ(verdict_on(two).products[0].held, HeldVerdict::kNotHeld);
  EXPECT_EQ(verdict_on(two).comparisons[0].verdict, PairVerdict::kNoneHeld);
}

TEST(SetVerdict, WhatTheHandOnlyLiesOnIsNotHeld) {
  std::vector<AssessedProduct> two = {held("a", 60, 0.40), held("b", 60, 0.10)};
  two[0].assessment.grasp.grip = grasp::Grip::kRestingHand;
  two[1].assessment.grasp.grip = grasp::Grip::kFingerPush;
  const SetVerdict verdict = verdict_on(two);
  EXPECT_EQ(name_of(verdict.products[0].held), "rests");
  EXPECT_EQ(name_of(verdict.products[1].held), "pushes");
  EXPECT_EQ(verdict.best, 1);  // pressures can be compared all the same
  two[1].assessment.balance.status = grasp::BalanceStatus::kSlipsOut;
  EXPECT_EQ(name_of(verdict_on(two).products[1].held), "doubtful");
  EXPECT_EQ(verdict_on(two).best, 0);
}

TEST(SetVerdict, OfThreeTheBestBeatsBoth) {
  EXPECT_EQ(verdict_on({held("a", 60, 0.4), held("b", 60, 0.2), held("c", 60, 0.3)}).best, 1);
  EXPECT_FALSE(verdict_on({held("a", 60, 0.4), held("b", 60, 0.2), held("c", 60, 0.21)}).best);
  EXPECT_TRUE(verdict_on({held("a", 60, 0.4)}).comparisons.empty());
}

TEST(SetVerdict, StrengthIsThatOfTheMusclesADynamometersStandsBeside) {
  AssessedProduct one = held("a", 106.75, 0.4);
  one.assessment.balance.strength_use = 0.63;
  const SetVerdict usual = verdict_on({one});
  ASSERT_TRUE(usual.products[0].strength);
  EXPECT_EQ(usual.products[0].strength->share, 0.63);
  EXPECT_NEAR(usual.products[0].strength->compared(), 106.75 / grasp::usual_grip_strength(), 1e-12);
  one.assessment.options.balance.share_of_strength =
      grasp::ShareOfStrength{.share = 0.5, .strength = 213.5, .whose = "her", .why_least = ""};
  EXPECT_NEAR(verdict_on({one}).products[0].strength->compared(), 0.5, 1e-12);
  EXPECT_EQ(verdict_on({one}).products[0].strength->share, 0.63);
  // Of a person's strength a pinch reaches a fifth (Mathiowetz et al. 1985); muscles don't judge
  // it.
  one.assessment.grasp.grip = grasp::Grip::kPalmarPinch;
  one.assessment.balance.strength_use.reset();
  const auto pinch = verdict_on({one}).products[0].strength;
  EXPECT_NEAR(pinch->reached, 213.5 * 109.9 / 541.8, 1e-9);
  EXPECT_FALSE(pinch->is_judged);
  EXPECT_FALSE(pinch->share);
  one.assessment.balance.status = grasp::BalanceStatus::kOff;
  EXPECT_FALSE(verdict_on({one}).products[0].strength);
}

}  // namespace
}  // namespace palmar::study
