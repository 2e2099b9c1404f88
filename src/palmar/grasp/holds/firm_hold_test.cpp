// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/firm_hold.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/grasp/joint_strength.h"

namespace palmar::grasp {
namespace {

RankedHold hold(Grip grip, double score, const std::string& words) {
  RankedHold one;
  one.hold.grip = grip;
  one.score = score;
  one.words = words;
  return one;
}

// Steiber 2016, 45 to 49 years: women 34.1 kg (SD 6.1), men 53.0 kg (SD 8.6). Half of the women
// reach their own mean, and of men those above 2.198 deviations below theirs: 98.60 %.
TEST(ShareWhoReach, IsTheTailOfBothSexesDistributions) {
  constexpr double kNewtonPerKg = 9.80665;
  EXPECT_NEAR(share_who_reach(34.1 * kNewtonPerKg, Grip::kMediumWrap, 45.0), 0.5 * (0.5 + 0.9860),
              1e-4);
  // Mathiowetz et al. 1985: 109.9 N between thumb and two fingers where the grip reaches 541.8 N.
  EXPECT_NEAR(share_who_reach(34.1 * kNewtonPerKg * 109.9 / 541.8, Grip::kTripod, 45.0),
              0.5 * (0.5 + 0.9860), 1e-4);
  EXPECT_EQ(share_who_reach(10.0, Grip::kMediumWrap, 12.0), 0.0);  // no child's strength is known
}

TEST(ForceTerm, AsksNothingOfWhatEverybodyCanAndMuchOfWhatNobodyCan) {
  EXPECT_NEAR(force_term(10.0, Grip::kTripod).score, 0.0, 0.01);
  EXPECT_NEAR(force_term(60.0, Grip::kMediumWrap).score, 0.0, 0.01);
  EXPECT_EQ(force_term(300.0, Grip::kTripod).score, -6.0);
  double before = 0.0;
  for (double force = 10.0; force < 120.0; force += 10.0) {
    const double score = force_term(force, Grip::kTripod).score;
    EXPECT_LE(score, before) << force;  // never easier when it is more
    before = score;
  }
}

// A tripod reaches 86.6 N on average (427.1 N times 0.2028), so 100 N is 115 % of it.
TEST(FirmHold, IsOneWhoseGripCanGiveTheForce) {
  const std::vector<RankedHold> pen = {hold(Grip::kTripod, 0.0, "tripod of the pen"),
                                       hold(Grip::kPalmarPinch, -0.5, "palmar pinch of the pen"),
                                       hold(Grip::kMediumWrap, -1.0, "medium wrap of the pen")};
  EXPECT_EQ(firm_hold(pen, 10.0).number, 1);
  EXPECT_EQ(firm_hold(pen, 10.0).why, "");
  const FirmHold firm = firm_hold(pen, 100.0);
  EXPECT_EQ(firm.number, 3);
  EXPECT_EQ(firm.why, "100 N is 115 % of what people reach in a tripod of the pen");
  // Where no grip can, the order is that of the shape.
  EXPECT_EQ(firm_hold({pen[0], pen[1]}, 400.0).number, 1);
}

TEST(FirmHold, KeepsTheFirstOfTwoThatAreAsGood) {
  const std::vector<RankedHold> bar = {hold(Grip::kMediumWrap, -0.65, "one end"),
                                       hold(Grip::kLargeDiameter, -0.50, "the other end")};
  EXPECT_EQ(firm_hold(bar, 60.0).number, 1);
}

}  // namespace
}  // namespace palmar::grasp
