// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/ligaments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::grasp {
namespace {

using hand::effort_test::plain_hand;

hand::PassiveMoments moments(const hand::Hand& hand, hand::Finger finger,
                             const hand::Posture& posture) {
  return ligament_moments(hand.skeleton, finger, posture, {});
}

TEST(Ligaments, PushJointsBackFromTheEndsOfTheirRanges) {
  const hand::Hand hand = plain_hand();
  for (int k = 0; k < hand::kDigitDofs; ++k) {
    const auto dofs = hand::digit_dofs(hand::Finger::kThumb);
    const hand::JointDof& dof = hand.skeleton.dof(dofs[static_cast<std::size_t>(k)]);
    hand::Posture below, above;
    below[dof.dof] = dof.lower - 0.1;
    above[dof.dof] = dof.upper + 0.1;
    const double least = 500.0 * std::exp(0.1 / 0.06);
    EXPECT_NEAR(moments(hand, hand::Finger::kThumb, below).moment[k], least, 1e-3 * least);
    EXPECT_NEAR(moments(hand, hand::Finger::kThumb, above).moment[k], -least, 1e-3 * least);
  }
}

TEST(Ligaments, LeaveTheUpperEndOfAFingersFlexionToPassiveMoments) {
  const hand::Hand hand = plain_hand();
  const auto dofs = hand::digit_dofs(hand::Finger::kRing);
  hand::Posture bent;
  bent[dofs[2]] = hand.skeleton.dof(dofs[2]).upper + 0.1;
  EXPECT_NEAR(moments(hand, hand::Finger::kRing, bent).moment[2], 0.0, 1e-9);
}

TEST(Ligaments, OfABentMcpResistAbduction) {
  const hand::Hand hand = plain_hand();
  const auto dofs = hand::digit_dofs(hand::Finger::kIndex);
  hand::Posture spread, bent;
  spread[dofs[1]] = bent[dofs[1]] = 0.1;
  bent[dofs[0]] = 1.4;
  EXPECT_GT(moments(hand, hand::Finger::kIndex, spread).moment[1], -100.0);
  EXPECT_LT(moments(hand, hand::Finger::kIndex, bent).moment[1], -900.0);
}

TEST(Ligaments, StiffnessIsTheSlopeOfTheMoments) {
  const hand::Hand hand = plain_hand();
  constexpr double kStep = 1e-6;
  for (const hand::Finger finger : {hand::Finger::kThumb, hand::Finger::kMiddle}) {
    const auto dofs = hand::digit_dofs(finger);
    hand::Posture posture;
    posture[dofs[0]] = 1.1;
    posture[dofs[1]] = hand.skeleton.dof(dofs[1]).upper - 0.02;
    posture[dofs[3]] = hand.skeleton.dof(dofs[3]).lower - 0.05;
    const hand::PassiveMoments here = moments(hand, finger, posture);
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      hand::Posture more = posture, less = posture;
      more[dofs[static_cast<std::size_t>(k)]] += kStep;
      less[dofs[static_cast<std::size_t>(k)]] -= kStep;
      const Eigen::Vector4d slope =
          (moments(hand, finger, more).moment - moments(hand, finger, less).moment) / (2.0 * kStep);
      EXPECT_LT((slope + here.stiffness.col(k)).norm(), 1e-5 * (1.0 + slope.norm())) << k;
    }
  }
}

}  // namespace
}  // namespace palmar::grasp
