// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/grip_muscles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar {
namespace {

using effort_test::plain_hand;
using effort_test::posture_of;

constexpr Finger kTried = Finger::kMiddle;

// Force of the muscles at their best length times the arms of their paths.
std::array<double, 3> at_best(const Hand& hand, const Posture& posture) {
  const PosedDigit digit = pose_digit(hand.skeleton, kTried, posture);
  const auto arms = moment_arms(route_tendons(hand, kTried), digit);
  const std::span<const Tendon> names = tendons_of(kTried);
  std::array<double, 3> sum{};
  for (std::size_t t = 0; t < names.size(); ++t) {
    const Tendon name = names[t];
    if (name != Tendon::kFdp && name != Tendon::kFds) continue;
    const double force = kSpecificTension * cross_section_of(kTried, name);
    std::size_t level = 0;
    for (std::size_t k = 0; k < arms[t].size(); ++k) {
      if (is_flexion(digit.dof[k])) sum[level++] += force * arms[t][k];
    }
  }
  return sum;
}

TEST(GripMuscles, GiveForceTimesArmInThePositionOfFunction) {
  const Hand hand = plain_hand();
  const Posture posture = posture_of(kTried, 45, 45, 25);
  const std::array<double, 3> moments = GripMuscles(hand).flexion_moments(kTried, posture);
  const std::array<double, 3> expected = at_best(hand, posture);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(moments[k], expected[k], 1e-9 * expected[0]);
}

TEST(GripMuscles, AreWeakerAwayFromThereByWhatTheirFibresLengthen) {
  const Hand hand = plain_hand();
  const GripMuscles muscles(hand);
  // DIP turns FDP alone: its excursion is the arm times the turn, nearly, over a cylinder.
  const Posture best = posture_of(kTried, 45, 45, 25);
  const Posture fist = posture_of(kTried, 85, 100, 60);
  const Posture straight = posture_of(kTried, 0, 5, 0);
  for (const Posture& posture : {fist, straight}) {
    const double here = muscles.flexion_moments(kTried, posture)[1];
    const double strongest = at_best(hand, posture)[1];
    EXPECT_LT(here, strongest);
    EXPECT_GT(here, 0.5 * strongest);  // excursions stay below half of the fibres
  }
  const auto dip = [&](const Posture& posture) {
    return muscles.flexion_moments(kTried, posture)[2];
  };
  EXPECT_GT(dip(best), 0.0);
}

TEST(GripMuscles, GrowWithTheHandsLengthsAsArmsDo) {
  // A hand twice as large: arms and excursions double, cross-sections and fibres stay.
  const Posture best = posture_of(kTried, 45, 45, 25);
  const double one = GripMuscles(plain_hand()).flexion_moments(kTried, best)[1];
  const double two = GripMuscles(plain_hand(2.0)).flexion_moments(kTried, best)[1];
  EXPECT_NEAR(two, 2.0 * one, 1e-9 * one);
}

// Middle finger bent to 45 degrees. PIP 1.46 N m (Li, Zatsiorsky & Latash 2000, lowest of their
// table 3, at second hand): nothing in the model comes from there.
TEST(GripMuscles, PredictTheMeasuredMomentOfThePipJoint) {
  const double pip =
      GripMuscles(plain_hand()).flexion_moments(kTried, posture_of(kTried, 45, 45, 25))[1];
  EXPECT_NEAR(pip, 1460.0, 0.35 * 1460.0);
}

}  // namespace
}  // namespace palmar
