// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/hand_muscles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using effort_test::plain_hand;
using effort_test::posture_of;

constexpr Finger kTried = Finger::kMiddle;

double strength_of(const DigitMuscles& digit, Tendon tendon) {
  const std::span<const Tendon> names = tendons_of(digit.finger);
  for (std::size_t t = 0; t < names.size(); ++t) {
    if (names[t] == tendon) return digit.strength[t];
  }
  return 0.0;
}

/// Largest moment of flexion about the k-th angle by the two long flexors.
double flexors(const Hand& hand, const Posture& posture, std::size_t k) {
  const DigitMuscles digit = HandMuscles(hand).in(kTried, posture);
  return digit.strength[0] * digit.arm[0][k] + digit.strength[1] * digit.arm[1][k];
}

TEST(HandMuscles, GiveCrossSectionTimesTensionInThePositionOfFunction) {
  const Hand hand = plain_hand();
  const DigitMuscles digit = HandMuscles(hand).in(kTried, posture_of(kTried, 45, 45, 25));
  for (const Tendon tendon : tendons_of(kTried)) {
    EXPECT_NEAR(strength_of(digit, tendon), kSpecificTension * cross_section_of(kTried, tendon),
                1e-9);
  }
}

TEST(HandMuscles, AreWeakerAwayFromThereByWhatTheirFibresLengthen) {
  const Hand hand = plain_hand();
  const HandMuscles muscles(hand);
  const double best = kSpecificTension * cross_section_of(kTried, Tendon::kFdp);
  for (const Posture& posture : {posture_of(kTried, 85, 100, 60), posture_of(kTried, 0, 5, 0)}) {
    const double here = strength_of(muscles.in(kTried, posture), Tendon::kFdp);
    EXPECT_LT(here, best);
    EXPECT_GT(here, 0.5 * best);  // excursions stay below half of the fibres
  }
  // DIP alone, by 10 degrees: the fibres of 83.5 mm change by the arm of FDP times the turn.
  const DigitMuscles turned = muscles.in(kTried, posture_of(kTried, 45, 45, 35));
  const double way =
      0.5 * (turned.arm[0][3] + muscles.in(kTried, posture_of(kTried, 45, 45, 25)).arm[0][3]) *
      10.0 * geometry::kDegree;
  EXPECT_NEAR(strength_of(turned, Tendon::kFdp), best * std::exp(-std::pow(way / 83.5, 2) / 0.45),
              2e-4 * best);
  EXPECT_NEAR(strength_of(turned, Tendon::kFds),
              kSpecificTension * cross_section_of(kTried, Tendon::kFds), 1e-9);
}

TEST(HandMuscles, GrowWithTheHandsLengthsAsArmsDo) {
  // A hand twice as large: arms and excursions double, cross-sections and fibres stay.
  const Posture best = posture_of(kTried, 45, 45, 25);
  const double one = flexors(plain_hand(), best, 2);
  EXPECT_NEAR(flexors(plain_hand(2.0), best, 2), 2.0 * one, 1e-9 * one);
}

// Middle finger bent to 45 degrees. PIP 1.46 N m (Li, Zatsiorsky & Latash 2000, lowest of their
// table 3, at second hand): nothing in the model comes from there.
TEST(HandMuscles, PredictTheMeasuredMomentOfThePipJoint) {
  EXPECT_NEAR(flexors(plain_hand(), posture_of(kTried, 45, 45, 25), 2), 1460.0, 0.35 * 1460.0);
}

TEST(ProblemOf, AsksMusclesForWhatLoadAndLigamentsLeave) {
  const Hand hand = plain_hand();
  const DigitMuscles digit = HandMuscles(hand).in(kTried, posture_of(kTried, 45, 45, 25));
  const MuscleProblem problem = problem_of(digit, {-300.0, 20.0, -200.0, 0.0}, 2.0);
  ASSERT_EQ(problem.required.size(), kDigitDofs);
  EXPECT_NEAR(problem.required[0], 300.0 - digit.passive.moment[0], 1e-9);
  EXPECT_NEAR(problem.required[1], -20.0, 1e-9);
  EXPECT_EQ(problem.stop[0], 0);
  EXPECT_EQ(problem.stop[3], 2);  // nothing presses there
  EXPECT_NEAR(problem.moment_at_strength(2, 1), 2.0 * digit.strength[1] * digit.arm[1][2], 1e-9);
}

}  // namespace
}  // namespace palmar::hand
