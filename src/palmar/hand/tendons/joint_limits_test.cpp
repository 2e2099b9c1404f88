// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/joint_limits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "palmar/geometry/degrees.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using effort_test::plain_hand;
using effort_test::posture_of;

constexpr Finger kBent = Finger::kIndex;
constexpr LigamentModel kNoStops{.stop_moment = 0.0};

// The published curve in N cm and degrees, by hand: at the end of the range it was counted from,
// 1.27 (exp(-0.031 x 37.31) - 1) - 1.83 (exp(0.07 x 25.73) - 1) = -10.1 N cm.
TEST(PassiveMoments, OfTheMcpAreTheMeasuredOnes) {
  const Hand hand = plain_hand();  // MCP to 90 degrees
  const auto at = [&](double mcp) {
    return passive_moments(hand.skeleton, kBent, posture_of(kBent, mcp, 45, 30), kNoStops)
        .moment[0];
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
  for (const Posture& posture :
       {posture_of(kBent, 95, 105, 85), posture_of(kBent, 10, 20, 60),
        posture_of(kBent, 45, 60, 10), posture_of(kBent, 2, 20, 10, 20),
        posture_of(kBent, 60, 40, 30, -15), posture_of(kBent, 88, 40, 30, 4)}) {
    const PassiveMoments here = passive_moments(hand.skeleton, kBent, posture);
    for (Eigen::Index k = 0; k < kDigitDofs; ++k) {
      Posture more = posture, less = posture;
      more[digit_dofs(kBent)[static_cast<std::size_t>(k)]] += kStep;
      less[digit_dofs(kBent)[static_cast<std::size_t>(k)]] -= kStep;
      const Eigen::Vector4d slope = (passive_moments(hand.skeleton, kBent, more).moment -
                                     passive_moments(hand.skeleton, kBent, less).moment) /
                                    (2.0 * kStep);
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
      passive_moments(hand.skeleton, kBent, posture_of(kBent, 45, 30, 45), kNoStops);
  EXPECT_NEAR(passive.moment[3], -1500.0 * 15.0 * geometry::kDegree, 1e-9);
  EXPECT_NEAR(passive.moment[2], 1000.0 * 15.0 * geometry::kDegree, 1e-9);
}

TEST(Ligaments, PushJointsBackFromTheEndsOfTheirRanges) {
  const Hand hand = plain_hand();
  const std::array<Dof, kDigitDofs> dofs = digit_dofs(Finger::kThumb);
  const double least = 500.0 * std::exp(0.1 / 0.06);
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    const JointDof& dof = hand.skeleton.dof(dofs[k]);
    const auto moment = [&](double angle) {
      Posture posture;
      posture[dof.dof] = angle;
      return passive_moments(hand.skeleton, Finger::kThumb, posture)
          .moment[static_cast<Eigen::Index>(k)];
    };
    EXPECT_NEAR(moment(dof.lower - 0.1), least, 1e-3 * least);
    EXPECT_NEAR(moment(dof.upper + 0.1), -least, 1e-3 * least);
  }
}

// Half of the range is left at 45 degrees, none at 90.
TEST(Ligaments, OfABentMcpLeaveLessAbduction) {
  const Hand hand = plain_hand();
  const JointDof& spread = hand.skeleton.dof(digit_dofs(kBent)[1]);
  const auto moment = [&](double mcp, double share) {
    Posture posture = posture_of(kBent, mcp, 30, 20);
    posture[spread.dof] = share * spread.upper;
    return passive_moments(hand.skeleton, kBent, posture).moment[1];
  };
  const double at_end = moment(-20.0, 1.0);
  EXPECT_NEAR(at_end, -500.0, 5.0);
  EXPECT_NEAR(moment(45.0, 0.5), at_end, 0.15 * 500.0);
  EXPECT_GT(moment(0.0, 0.5), 0.1 * at_end);
  EXPECT_LT(moment(85.0, 0.5), 4.0 * at_end);
}

// What ligaments do to flexion was measured with the finger straight ahead.
TEST(Ligaments, LeaveFlexionAloneWhereNothingIsSpread) {
  const Hand hand = plain_hand();
  for (const double mcp : {60.0, 80.0, 95.0}) {  // far from the other end of the range
    const Posture posture = posture_of(kBent, mcp, 30, 20);
    EXPECT_NEAR(passive_moments(hand.skeleton, kBent, posture).moment[0],
                passive_moments(hand.skeleton, kBent, posture, kNoStops).moment[0], 1e-2);
  }
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
