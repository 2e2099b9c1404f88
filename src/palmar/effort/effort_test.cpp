// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/effort.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::effort {
namespace {

using hand::effort_test::kFingers;
using hand::effort_test::plain_hand;
using hand::effort_test::vertex_of;

/// Half bent fingers, thumb in opposition.
hand::Posture grip_posture(const hand::Hand& hand) {
  hand::Posture posture = hand::reference_posture(hand.skeleton);
  for (const hand::Finger finger :
       {hand::Finger::kIndex, hand::Finger::kMiddle, hand::Finger::kRing, hand::Finger::kLittle}) {
    const hand::Posture bent = hand::effort_test::posture_of(finger, 45, 50, 30);
    for (const char* joint : {"mcp_flexion", "pip_flexion", "dip_flexion"}) {
      posture[hand::effort_test::dof_of(finger, joint)] =
          bent[hand::effort_test::dof_of(finger, joint)];
    }
  }
  posture[hand::Dof::kThumbMpFlexion] = 0.3;
  posture[hand::Dof::kThumbIpFlexion] = 0.4;
  posture[hand::Dof::kThumbCmcAbduction] = 0.1;
  posture[hand::Dof::kThumbCmcFlexion] = 0.1;
  return posture;
}

/// A product pushes every phalanx off by `force` [N], perpendicular to it in its plane of flexion.
std::vector<SkinForce> grip_loads(const hand::Hand& hand, const hand::Posture& posture,
                                  double force) {
  std::vector<SkinForce> loads;
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand.skeleton, posture);
  for (int s = 1; s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    const geometry::Rigid3& bone = posed.segment[s];
    const auto v = static_cast<std::size_t>(vertex_of(segment));
    const hand::JointDof& flexion = hand.skeleton.joint(hand::joint_of(segment)).dofs.back();
    const Vec3 along = hand.skin.vertices[v] - hand.skeleton.joint(hand::joint_of(segment)).centre;
    const Vec3 palmar = flexion.axis.cross(along).normalized();
    loads.push_back(
        {static_cast<int>(v), bone * hand.skin.vertices[v], bone.rotation * Vec3(-force * palmar)});
  }
  return loads;
}

TEST(JointMoments, ForceTimesLever) {
  // Straight finger along y; 2 N in the middle of the distal phalanx push dorsally (-z): every
  // flexion joint is extended by 2 N times its distance.
  const hand::Hand hand = plain_hand();
  const hand::Posture posture;
  const std::vector<SkinForce> loads = {{vertex_of(hand::Segment::kRingDistal),
                                         hand.skin.vertices[vertex_of(hand::Segment::kRingDistal)],
                                         Vec3(0, 0, -2)}};
  const hand::PosedDigit digit = hand::pose_digit(hand.skeleton, hand::Finger::kRing, posture);
  const DigitMoments moments = digit_moments(hand, digit, loads);
  EXPECT_NEAR(moments.force, 2.0, 1e-12);
  const double tip = 0.5 * hand::effort_test::kDistal;
  for (std::size_t k = 0; k < hand::kDigitDofs; ++k) {
    double expected = 0.0;
    if (digit.dof[k] == hand::Dof::kRingDipFlexion) expected = -2.0 * tip;
    if (digit.dof[k] == hand::Dof::kRingPipFlexion)
      expected = -2.0 * (tip + hand::effort_test::kMiddle);
    if (digit.dof[k] == hand::Dof::kRingMcpFlexion) {
      expected = -2.0 * (tip + hand::effort_test::kMiddle + hand::effort_test::kProximal);
    }
    EXPECT_NEAR(moments.moment[k], expected, 1e-10) << name_of(digit.dof[k]);
  }
  EXPECT_EQ(
      digit_moments(hand, hand::pose_digit(hand.skeleton, hand::Finger::kIndex, posture), loads)
          .force,
      0.0);
}

/// Solid below z = 0 of the product's frame.
class Floor : public geometry::DistanceField {
 public:
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      samples[i] = {points[i].z(), Vec3(points[i].x(), points[i].y(), 0.0), Vec3::UnitZ(), 0};
    }
  }
  Box3 bounding_box() const override { return {Vec3(-100, -100, -1), Vec3(100, 100, 0)}; }
};

TEST(JointMoments, ProductPushesTheSkinOutwardsAndFrictionTurnsRound) {
  contact::ContactResult contact;
  contact.force = {0.0, 3.0};
  contact.undeformed = {Vec3(0, 0, 5), Vec3(4, 5, -1)};
  contact.deformed = {Vec3(0, 0, 5), Vec3(4, 5, 0)};
  contact::FrictionResult friction;
  friction.force = {Vec3::Zero(), Vec3(0.5, 0, 0)};
  // The product's z is the hand's y.
  const geometry::Rigid3 product_from_hand{
      Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX())), Vec3(1, 2, 3)};
  const auto loads = skin_loads(contact, product_from_hand, Floor(), &friction);
  ASSERT_EQ(loads.size(), 1U);
  EXPECT_EQ(loads[0].vertex, 1);
  EXPECT_LT((loads[0].force - Vec3(-0.5, 3, 0)).norm(), 1e-12);
  EXPECT_LT((loads[0].point - Vec3(3, -3, -3)).norm(), 1e-12);
}

TEST(Effort, MusclesBalanceEveryJoint) {
  const hand::Hand hand = plain_hand();
  const hand::Posture posture = grip_posture(hand);
  const EffortResult effort = assess_effort(hand, posture, grip_loads(hand, posture, 3.0));
  for (std::size_t f = 1; f < hand::kFingerCount; ++f) {
    EXPECT_EQ(effort.digits[f].status, EffortStatus::kHeld) << effort.message;
  }
  EXPECT_NEAR(effort.contact_force, 42.0, 1e-9);
  for (const DigitEffort& digit : effort.digits) {
    EXPECT_LT(digit.kkt_residual, 1e-6);
    for (std::size_t k = 0; k < hand::kDigitDofs; ++k) {
      const JointEffort& joint = digit.joints[k];
      double muscles = 0.0;
      for (const TendonLoad& load : digit.tendons) muscles += load.force * load.moment_arm[k];
      EXPECT_NEAR(muscles, joint.muscles, 1e-9);
      EXPECT_NEAR(joint.external + joint.muscles + joint.stop + joint.missing, 0.0, 1e-4)
          << name_of(joint.dof);
    }
    for (const TendonLoad& load : digit.tendons) {
      EXPECT_GE(load.force, 0.0);
      EXPECT_LE(load.activation, 1.0);
    }
  }
  // Gripping is done by flexors.
  EXPECT_GT(effort.digits[2].tendons[0].force + effort.digits[2].tendons[1].force, 5.0);
  EXPECT_LT(effort.digits[2].tendons[2].force, 1.0);
}

TEST(Effort, NothingHeldNothingDone) {
  const hand::Hand hand = plain_hand();
  const EffortResult effort = assess_effort(hand, grip_posture(hand), std::vector<SkinForce>{});
  EXPECT_EQ(effort.status, EffortStatus::kNoLoad);
  EXPECT_EQ(effort.tendon_force, 0.0);
  for (const grasp::GraspIndex& index : effort_indices(effort)) {
    EXPECT_EQ(index.value, std::nullopt);
    EXPECT_THAT(index.remark, testing::HasSubstr("no digit touches"));
  }
}

TEST(Effort, HeavierLoadNeverLowersTendonForce) {
  const hand::Hand hand = plain_hand();
  const hand::Posture posture = grip_posture(hand);
  for (const int exponent : {2, 3}) {
    double last_sum = 0.0, last_missing = 0.0;
    for (const double force : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
      const EffortResult effort =
          assess_effort(hand, posture, grip_loads(hand, posture, force), {.exponent = exponent});
      ASSERT_NE(effort.status, EffortStatus::kNotConverged);
      double missing = 0.0;
      for (const DigitEffort& digit : effort.digits) {
        for (const JointEffort& joint : digit.joints) missing += std::abs(joint.missing);
      }
      EXPECT_GE(missing, last_missing);
      if (missing == 0.0) {
        EXPECT_GT(effort.tendon_force, last_sum);
      }
      last_sum = effort.tendon_force;
      last_missing = missing;
    }
    EXPECT_GT(last_missing, 0.0);  // 64 N on every phalanx is more than a hand can hold
  }
}

TEST(Effort, ForcesScaleWithTheLoadUntilAMuscleIsFull) {
  const hand::Hand hand = plain_hand();
  const hand::Posture posture = grip_posture(hand);
  const EffortResult one =
      assess_effort(hand, posture, grip_loads(hand, posture, 1.0), {.exponent = 2});
  const EffortResult three =
      assess_effort(hand, posture, grip_loads(hand, posture, 3.0), {.exponent = 2});
  for (std::size_t f = 0; f < hand::kFingerCount; ++f) {
    for (std::size_t t = 0; t < one.digits[f].tendons.size(); ++t) {
      EXPECT_NEAR(three.digits[f].tendons[t].force, 3.0 * one.digits[f].tendons[t].force, 1e-4);
    }
  }
}

TEST(Effort, LeftHandDoesWhatTheRightOneDoes) {
  const hand::Hand hand = plain_hand(), left = hand::mirrored(hand);
  const hand::Posture posture = grip_posture(hand);
  std::vector<SkinForce> loads = grip_loads(hand, posture, 5.0);
  const EffortResult right = assess_effort(hand, posture, loads);
  for (SkinForce& load : loads) {
    load.point.x() *= -1.0;
    load.force.x() *= -1.0;
  }
  const EffortResult image = assess_effort(left, posture, loads);
  for (std::size_t f = 0; f < hand::kFingerCount; ++f) {
    for (std::size_t t = 0; t < right.digits[f].tendons.size(); ++t) {
      EXPECT_NEAR(image.digits[f].tendons[t].force, right.digits[f].tendons[t].force, 1e-5);
    }
  }
}

TEST(Effort, OverloadNamesJointAndMoment) {
  const hand::Hand hand = plain_hand();
  const hand::Posture posture = grip_posture(hand);
  const std::vector<SkinForce> all = grip_loads(hand, posture, 300.0);
  const std::vector<SkinForce> tip = {all[vertex_of(hand::Segment::kIndexDistal)]};
  const EffortResult effort = assess_effort(hand, posture, tip);
  EXPECT_EQ(effort.status, EffortStatus::kOverloaded);
  EXPECT_THAT(effort.message, testing::MatchesRegex(".*index DIP flexion: [0-9]+ N mm missing.*"));
  EXPECT_EQ(effort.digits[2].status, EffortStatus::kNoLoad);
  bool is_reported = false;
  for (const grasp::GraspIndex& index : effort_indices(effort)) {
    if (index.key != "missing_moment_n_mm") continue;
    is_reported = index.value && *index.value > 100.0;
  }
  EXPECT_TRUE(is_reported);
}

TEST(Effort, StrongerPersonWorksLess) {
  const hand::Hand hand = plain_hand();
  const hand::Posture posture = grip_posture(hand);
  const auto loads = grip_loads(hand, posture, 2.0);
  const auto largest = [&](double strength) {
    return *effort_indices(assess_effort(hand, posture, loads, {.strength = strength}))[0].value;
  };
  EXPECT_NEAR(largest(2.0), 0.5 * largest(1.0), 1e-6);
}

TEST(Effort, JointAtItsEndIsHeldByLigaments) {
  // Index held straight at the end of DIP extension while its tip is pushed dorsally.
  const hand::Hand hand = plain_hand();
  hand::Posture posture = hand::effort_test::posture_of(hand::Finger::kIndex, 30, 30, -10);
  const auto loads = grip_loads(hand, posture, 2.0);
  const EffortResult with = assess_effort(hand, posture, loads);
  const EffortResult without = assess_effort(hand, posture, loads, {.joint_stops = false});
  const JointEffort& dip = with.digits[1].joints[3];
  EXPECT_EQ(dip.dof, hand::Dof::kIndexDipFlexion);
  EXPECT_LT(dip.external, 0.0);
  EXPECT_GT(dip.stop, 0.0);  // pushes the angle up, off its lower end
  EXPECT_EQ(without.digits[1].joints[3].stop, 0.0);
  const auto cost = [](const EffortResult& effort) {
    double sum = 0.0;
    for (const TendonLoad& load : effort.digits[1].tendons) sum += std::pow(load.activation, 3);
    return sum;
  };
  EXPECT_LE(cost(with), cost(without) + 1e-9);
}

TEST(Effort, BentMcpIsHeldSidewaysByLigaments) {
  const hand::Hand hand = plain_hand();
  for (const double flexion : {50.0, 70.0}) {
    const hand::Posture posture =
        hand::effort_test::posture_of(hand::Finger::kRing, flexion, 30, 30);
    std::vector<SkinForce> loads = grip_loads(hand, posture, 1.0);
    for (SkinForce& load : loads) load.force.x() += 1.0;  // towards the thumb
    const EffortResult effort = assess_effort(hand, posture, loads);
    for (const JointEffort& joint : effort.digits[3].joints) {
      if (joint.dof != hand::Dof::kRingMcpAbduction) continue;
      EXPECT_GT(joint.external, 50.0);
      EXPECT_EQ(joint.stop<-10.0, flexion> 60.0) << joint.stop;
    }
  }
}

TEST(Effort, BadOptionsAreNamed) {
  const hand::Hand hand = plain_hand();
  const auto with = [&](const EffortOptions& options) {
    return [&hand, options] {
      assess_effort(hand, hand::Posture{}, std::vector<SkinForce>{}, options);
    };
  };
  EXPECT_THAT(with({.exponent = 1}),
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("exponent is 1; 2 or 3")));
  EXPECT_THAT(with({.strength = 0.0}),
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("effort: strength is 0")));
  EXPECT_THAT(with({.specific_tension = 45.0}),
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("10.000000 MPa is allowed")));
}

}  // namespace
}  // namespace palmar::effort
