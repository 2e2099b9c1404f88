// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/fingertip_force.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::effort {
namespace {

using hand::effort_test::kFingers;
using hand::effort_test::plain_hand;
using hand::effort_test::posture_of;

TEST(FingertipForce, DoesTheWorkOfTheTendon) {
  // Virtual work in any motion: F r_k = f . v_k + m (omega_k . e).
  const hand::Hand hand = plain_hand();
  std::mt19937 random(23);
  for (const hand::Finger finger : kFingers) {
    const hand::DigitTendons tendons = hand::route_tendons(hand, finger);
    hand::Posture posture = hand::effort_test::random_posture(hand.skeleton, finger, random);
    const hand::PosedDigit bent = hand::pose_digit(hand.skeleton, finger, posture);
    posture[bent.dof[3]] = 0.5;  // never straight
    posture[bent.dof[2]] = 0.7;
    const hand::PosedDigit digit = hand::pose_digit(hand.skeleton, finger, posture);
    const int body = hand::distal_body(finger);
    const Vec3 axis = digit.body[body].rotation * hand.skeleton.dof(digit.dof.back()).axis;
    for (const hand::Tendon tendon : hand::tendons_of(finger)) {
      const FingertipForce tip = fingertip_force(hand, tendons, posture, tendon, 2.5);
      for (int k = 0; k < hand::kDigitDofs; ++k) {
        const double work = tip.force.dot(digit.velocity(k, body, tip.point)) +
                            tip.moment * digit.twist[k].omega.dot(axis);
        EXPECT_NEAR(work, 2.5 * tip.moment_arm[k], 1e-8);
      }
      EXPECT_NEAR(tip.force.norm(), tip.force_in_phalanx.norm(), 1e-9);
    }
  }
}

TEST(FingertipForce, IsThatOfThePlanarFinger) {
  // By hand: with the moment about the DIP free, the difference of PIP and DIP moments is what the
  // force does across the middle phalanx, that of MCP and PIP across the proximal one.
  const hand::Hand hand = plain_hand();
  const double mcp = 40 * geometry::kDegree, pip = 55 * geometry::kDegree,
               dip = 35 * geometry::kDegree;
  const FingertipForce tip =
      fingertip_force(hand, hand::route_tendons(hand, hand::Finger::kMiddle),
                      posture_of(hand::Finger::kMiddle, 40, 55, 35), hand::Tendon::kFdp, 1.0);
  double tau_mcp = 0.0, tau_pip = 0.0, tau_dip = 0.0;
  for (std::size_t k = 0; k < hand::kDigitDofs; ++k) {
    if (tip.dof[k] == hand::Dof::kMiddleMcpFlexion) tau_mcp = tip.moment_arm[k];
    if (tip.dof[k] == hand::Dof::kMiddlePipFlexion) tau_pip = tip.moment_arm[k];
    if (tip.dof[k] == hand::Dof::kMiddleDipFlexion) tau_dip = tip.moment_arm[k];
  }
  // Angles of the phalanges from y towards z (palmar); a force (fy, fz) turns by fz y - fy z.
  const double a = mcp, b = mcp + pip, c = mcp + pip + dip;
  Eigen::Matrix2d across;
  across << -hand::effort_test::kMiddle * std::sin(b), hand::effort_test::kMiddle * std::cos(b),
      -hand::effort_test::kProximal * std::sin(a), hand::effort_test::kProximal * std::cos(a);
  const Eigen::Vector2d f =
      across.inverse() * Eigen::Vector2d(tau_pip - tau_dip, tau_mcp - tau_pip);
  EXPECT_NEAR(tip.force.y(), f[0], 1e-9);
  EXPECT_NEAR(tip.force.z(), f[1], 1e-9);
  EXPECT_NEAR(tip.force_in_phalanx.y(), f[0] * std::cos(c) + f[1] * std::sin(c), 1e-9);
  EXPECT_NEAR(tip.force_in_phalanx.z(), -f[0] * std::sin(c) + f[1] * std::cos(c), 1e-9);
}

/// Force at the tip of the middle finger per newton in the tendon, in the distal phalanx: distal
/// and palmar, mean of the fingers H01 to H03.
struct Measured {
  double mcp, pip, dip;  ///< deg
  hand::Tendon tendon;
  double distal, palmar;
};

// Synek et al. 2019 (PeerJ 7:e7470), data of the article: 950 g hung on FDP and FDS, 400 g on EDC,
// of which pulleys let 83.5 % through.
constexpr Measured kMeasured[] = {{40, 55, 35, hand::Tendon::kFdp, 0.059, 0.247},
                                  {40, 55, 35, hand::Tendon::kFds, 0.157, 0.179},
                                  {40, 55, 35, hand::Tendon::kEdc, -0.128, 0.075},
                                  {55, 57, 25, hand::Tendon::kFdp, 0.042, 0.224},
                                  {55, 57, 25, hand::Tendon::kFds, 0.148, 0.164},
                                  {-20, 50, 45, hand::Tendon::kFdp, 0.030, 0.315},
                                  {-20, 50, 45, hand::Tendon::kFds, 0.096, 0.265},
                                  {0, 65, 50, hand::Tendon::kFdp, 0.093, 0.288},
                                  {0, 65, 50, hand::Tendon::kFds, 0.165, 0.231}};

TEST(FingertipForce, IsNearThatOfCadavers) {
  // The tendon points were calibrated by these forces (by the authors, on another skeleton): what
  // is held here is the whole chain from points to force, not the anatomy. Three fingers differ
  // among each other by about 0.05 N per N.
  const hand::Hand hand = plain_hand();
  const hand::DigitTendons tendons = hand::route_tendons(hand, hand::Finger::kMiddle);
  for (const Measured& m : kMeasured) {
    const FingertipForce tip = fingertip_force(
        hand, tendons, posture_of(hand::Finger::kMiddle, m.mcp, m.pip, m.dip), m.tendon, 1.0);
    EXPECT_NEAR(tip.force_in_phalanx.y(), m.distal, 0.05) << name_of(m.tendon) << " " << m.mcp;
    EXPECT_NEAR(tip.force_in_phalanx.z(), m.palmar, 0.05) << name_of(m.tendon) << " " << m.mcp;
  }
}

TEST(FingertipForce, GrowsWithTheTendonForceAndIsMirrored) {
  const hand::Hand hand = plain_hand(), left = hand::mirrored(hand);
  const hand::Posture posture = posture_of(hand::Finger::kRing, 30, 40, 30, 5);
  const FingertipForce one = fingertip_force(hand, hand::route_tendons(hand, hand::Finger::kRing),
                                             posture, hand::Tendon::kLum, 1.0);
  const FingertipForce ten = fingertip_force(hand, hand::route_tendons(hand, hand::Finger::kRing),
                                             posture, hand::Tendon::kLum, 10.0);
  const FingertipForce image = fingertip_force(left, hand::route_tendons(left, hand::Finger::kRing),
                                               posture, hand::Tendon::kLum, 1.0);
  EXPECT_LT((ten.force - 10.0 * one.force).norm(), 1e-9);
  EXPECT_LT((image.force - Vec3(-one.force.x(), one.force.y(), one.force.z())).norm(), 1e-9);
  EXPECT_LT((image.force_in_phalanx - one.force_in_phalanx).norm(), 1e-9);
}

TEST(FingertipForce, BadInputIsNamed) {
  const hand::Hand hand = plain_hand();
  const hand::DigitTendons tendons = hand::route_tendons(hand, hand::Finger::kMiddle);
  const hand::Posture bent = posture_of(hand::Finger::kMiddle, 40, 55, 35);
  EXPECT_THAT([&] { fingertip_force(hand, tendons, bent, hand::Tendon::kFpl, 1.0); },
              testing::ThrowsMessage<UsageError>(
                  testing::HasSubstr("the middle has no tendon fpl; it has fdp, fds")));
  for (const double force : {0.0, -1.0, 2000.0, std::nan("")}) {
    EXPECT_THAT([&] { fingertip_force(hand, tendons, bent, hand::Tendon::kFdp, force); },
                testing::ThrowsMessage<UsageError>(testing::HasSubstr("above 0 and at most")));
  }
  EXPECT_THAT(
      [&] {
        fingertip_force(hand, tendons, posture_of(hand::Finger::kMiddle, 30, 0, 0),
                        hand::Tendon::kFdp, 1.0);
      },
      testing::ThrowsMessage<NumericalError>(testing::HasSubstr("middle is too straight")));
}

}  // namespace
}  // namespace palmar::effort
