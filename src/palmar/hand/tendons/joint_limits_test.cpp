// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/joint_limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/geometry/degrees.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using effort_test::plain_hand;
using effort_test::posture_of;

constexpr Finger kBent = Finger::kIndex;

// The published curve in N cm and degrees, by hand: at the end of the range it was counted from,
// 1.27 (exp(-0.031 x 37.31) - 1) - 1.83 (exp(0.07 x 25.73) - 1) = -10.1 N cm.
TEST(PassiveMoments, OfTheMcpAreTheMeasuredOnes) {
  const Hand hand = plain_hand();  // MCP to 90 degrees
  const auto at = [&](double mcp) {
    return passive_moments(hand.skeleton, kBent, posture_of(kBent, mcp, 45, 30)).moment[0];
  };
  const auto published = [](double q) {
    return 1.27 * (std::exp(-0.031 * (q - 47.39)) - 1.0) -
           1.83 * (std::exp(0.07 * (q - 58.97)) - 1.0);
  };
  EXPECT_NEAR(at(90.0), 10.0 * published(84.7), 1e-6);
  EXPECT_NEAR(at(90.0), -101.0, 1.0);
  EXPECT_NEAR(at(0.0), 10.0 * published(-5.3), 1e-6);
  EXPECT_GT(at(0.0), 0.0);  // a straight finger is pulled into flexion
}

TEST(PassiveMoments, StiffnessIsTheirSlope) {
  const Hand hand = plain_hand();
  constexpr double kStep = 1e-6;
  for (const Posture& posture : {posture_of(kBent, 95, 105, 85), posture_of(kBent, 10, 20, 60),
                                 posture_of(kBent, 45, 60, 10)}) {
    const PassiveMoments here = passive_moments(hand.skeleton, kBent, posture);
    for (Eigen::Index k = 0; k < kDigitDofs; ++k) {
      Posture there = posture;
      there[digit_dofs(kBent)[static_cast<std::size_t>(k)]] += kStep;
      const Eigen::Vector4d slope =
          (passive_moments(hand.skeleton, kBent, there).moment - here.moment) / kStep;
      for (Eigen::Index i = 0; i < kDigitDofs; ++i) {
        EXPECT_NEAR(slope[i], -here.stiffness(i, k), 1e-3 * (1.0 + std::abs(slope[i])));
      }
    }
  }
}

TEST(PassiveMoments, CouplingPullsBothJointsTogether) {
  const Hand hand = plain_hand();
  // DIP 25 degrees beyond 2/3 of PIP: 15 beyond what is free.
  const PassiveMoments passive =
      passive_moments(hand.skeleton, kBent, posture_of(kBent, 45, 30, 45));
  EXPECT_NEAR(passive.moment[3], -1500.0 * 15.0 * geometry::kDegree, 1e-9);
  EXPECT_NEAR(passive.moment[2], 1000.0 * 15.0 * geometry::kDegree, 1e-9);
}

TEST(JointStops, HoldAnglesAtTheirEnds) {
  const Hand hand = plain_hand();
  const auto stop = [&](Dof dof, const Posture& posture) {
    return stop_of(hand.skeleton, dof, posture, {});
  };
  EXPECT_EQ(stop(Dof::kIndexPipFlexion, posture_of(kBent, 30, 0, 0)), 1);
  EXPECT_EQ(stop(Dof::kIndexPipFlexion, posture_of(kBent, 30, 110, 0)), 0);  // passive moments
  EXPECT_EQ(stop(Dof::kIndexMcpAbduction, posture_of(kBent, 30, 0, 0, 30)), -1);
  EXPECT_EQ(stop(Dof::kIndexMcpAbduction, posture_of(kBent, 61, 0, 0)), 2);
  Posture thumb;
  thumb[Dof::kThumbIpFlexion] = 80 * geometry::kDegree;
  EXPECT_EQ(stop(Dof::kThumbIpFlexion, thumb), -1);
  EXPECT_EQ(stop_of(hand.skeleton, Dof::kThumbIpFlexion, thumb, {.is_on = false}), 0);
}

}  // namespace
}  // namespace palmar::hand
