// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/held_torque.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/study/assessment/grasp_indices.h"

namespace palmar::study {
namespace {

using contact::contact_test::ball_hand;
using contact::contact_test::HalfSpace;

/// A ball of skin of 10 mm, pressed 1 mm into a plane across z: Hertz' contact.
struct PressedBall {
  static constexpr double kRadius = 10.0, kDepth = 1.0;  // mm
  contact::PreparedHand prepared{ball_hand(kRadius, 4)};
  HalfSpace plane{-kRadius + kDepth};
  contact::ContactResult contact = contact::solve_hand_contact(
      prepared, prepared.hand().skin.vertices, geometry::Rigid3{}, plane, [] {
        contact::ContactOptions options;
        options.swelling = false;
        return options;
      }());
  double torque(double friction, const Vec3& axis = Vec3::UnitZ()) const {
    return held_torque(prepared, contact, plane, {.axis = axis, .at = contact.total.centre},
                       friction);
  }
};

TEST(HeldTorque, OfAHertzContactAboutItsNormalIsLubkins) {
  // 3 pi / 16 mu P a (Lubkin 1951), a = sqrt(R d); through contact and mesh: 5 %.
  const PressedBall ball;
  ASSERT_EQ(ball.contact.status, contact::ContactStatus::kSolved);
  const double a = std::sqrt(PressedBall::kRadius * PressedBall::kDepth);
  const double expected = 3.0 * std::numbers::pi / 16.0 * 0.5 * ball.contact.total.force * a;
  EXPECT_NEAR(ball.torque(0.5) / expected, 1.0, 0.05);
}

TEST(HeldTorque, GrowsWithFrictionAndNeedsNoLengthOfTheAxis) {
  const PressedBall ball;
  const double once = ball.torque(0.3);
  EXPECT_NEAR(ball.torque(0.6), 2.0 * once, 1e-3 * once);  // forces are kept
  EXPECT_NEAR(ball.torque(0.3, Vec3(0, 0, -7.0)), once, 1e-3 * once);
  EXPECT_EQ(ball.torque(0.0), 0.0);
  EXPECT_LT(ball.torque(0.3, Vec3::UnitX()), 1e-3 * once);  // nothing holds a roll off the plane
}

TEST(HeldTorque, IsAmongTheIndicesThatAStudyMayAskFor) {
  int found = 0;
  for (const grasp::GraspIndex& row : index_catalogue()) {
    if (row.key != kHeldTorqueKey) continue;
    ++found;
    EXPECT_FALSE(row.value.has_value());
    EXPECT_EQ(row.better, grasp::Better::kUp);
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace palmar::study
