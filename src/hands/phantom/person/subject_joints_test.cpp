// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/subject_joints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar::phantom {
namespace {

// A PIP joint at the origin: phalanx along y, flexion about x, towards z.
SubjectJoints one_finger() {
  SubjectJoints joints;
  for (int body = 1; body < hand::kSegmentCount; ++body) {
    joints.phalanx[body].flexion = hand::Dof::kRingPipFlexion;
  }
  RollingJoint& pip = joints.phalanx[index_of(hand::Segment::kIndexMiddle)];
  pip.flexion = hand::Dof::kIndexPipFlexion;
  pip.radius = 4.0;
  pip.ellipse = 0.1;
  pip.creep = 0.3;
  return joints;
}

constexpr int kPip = static_cast<int>(hand::Segment::kIndexMiddle);

hand::Posture bent(double degrees) {
  hand::Posture posture;
  posture[hand::Dof::kIndexPipFlexion] = degrees * geometry::kDegree;
  return posture;
}

TEST(SubjectJoints, NothingMovesAtTheReference) {
  for (const geometry::Rigid3& m : body_motions(one_finger(), hand::Posture{})) {
    EXPECT_EQ(m.rotation.vec().norm(), 0.0);
    EXPECT_EQ(m.translation.norm(), 0.0);
  }
}

TEST(SubjectJoints, APhalanxFollowsTheEllipseOfTheHead) {
  // Bent by 90 degrees the base stands on the long half axis: 4 (1.1 - 1) mm farther out along the
  // phalanx, which then points to z, and has crept by 0.3 mm along its palmar side, then -y.
  const geometry::Rigid3 m = joint_motion(one_finger().phalanx[kPip], bent(90.0));
  const Vec3 centre = m * Vec3::Zero();
  EXPECT_NEAR(centre.z(), 0.4, 1e-12);
  EXPECT_NEAR(centre.y(), -0.3, 1e-12);
  EXPECT_NEAR((m.rotation * Vec3::UnitY() - Vec3::UnitZ()).norm(), 0.0, 1e-12);
}

TEST(SubjectJoints, TheInstantCentreMovesByTenthsOfAMillimetre) {
  std::vector<Vec3> centre;
  for (const double degrees : {0.0, 20.0, 40.0, 60.0, 80.0}) {
    centre.push_back(
        instant_axis(one_finger(), bent(degrees), kPip, hand::Dof::kIndexPipFlexion).point);
  }
  double most = 0.0;
  for (const Vec3& a : centre) {
    for (const Vec3& b : centre) most = std::max(most, (a - b).norm());
  }
  EXPECT_GT(most, 0.25);
  EXPECT_LT(most, 1.5);
}

TEST(SubjectJoints, APulleyWithoutEllipseAndCreepIsAHinge) {
  SubjectJoints joints = one_finger();
  RollingJoint& pip = joints.phalanx[kPip];
  pip.ellipse = pip.creep = 0.0;
  pip.centre = Vec3(3.0, 40.0, -2.0);
  const InstantAxis axis = instant_axis(joints, bent(30.0), kPip, hand::Dof::kIndexPipFlexion);
  EXPECT_NEAR((axis.axis - Vec3::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((axis.point - pip.centre).norm(), 0.0, 1e-7);
}

TEST(SubjectJoints, NoFixedAxisReproducesTheSaddleJoint) {
  SaddleJoint cmc;
  cmc.flexion_axis = Vec3(-0.27, -0.64, 0.72).normalized();  // Mirakhorlo et al. 2016, table 3
  cmc.abduction_axis = Vec3(0.78, -0.61, -0.13).normalized();
  cmc.abduction_point = Vec3(1.0, 1.0, 4.8);
  cmc.by_flexion = 0.2;
  cmc.by_abduction = -0.12;
  std::vector<Quat> limit;
  for (const auto& [f, a] : {std::pair{22.0, 0.0}, {-22.0, 0.0}, {0.0, 22.0}, {0.0, -22.0}}) {
    hand::Posture posture;
    posture[hand::Dof::kThumbCmcFlexion] = f * geometry::kDegree;
    posture[hand::Dof::kThumbCmcAbduction] = a * geometry::kDegree;
    limit.push_back(joint_motion(cmc, posture).rotation);
  }
  // Whatever the axis: after the best turn about it a swing perpendicular to it is left, which
  // moves the head of a metacarpal of 45 mm by at least 45 mm times the swing's share perpendicular
  // to the bone. The mean over directions of the swing is bounded here by a quarter of it.
  double least = 1e9;
  constexpr int kDirections = 4000;
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1.0 - (k + 0.5) / kDirections,
                 angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const Vec3 axis(r * std::cos(angle), r * std::sin(angle), z);
    double missed = 0.0;
    for (const Quat& q : limit) {
      const double along = q.vec().dot(axis);
      const double cosine = std::hypot(q.w(), along);  // of half the swing
      missed += 0.25 * 45.0 * 2.0 * std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / 4.0;
    }
    least = std::min(least, missed);
  }
  EXPECT_GT(least, 1.0);  // mm
}

TEST(SubjectJoints, QuaternionsAlongAFingerDontJump) {
  // Three joints bent by 80 degrees each: 240 degrees in all, more than half a turn.
  SubjectJoints joints;
  hand::Posture posture;
  const std::array<hand::Dof, 3> dof{hand::Dof::kIndexMcpFlexion, hand::Dof::kIndexPipFlexion,
                                     hand::Dof::kIndexDipFlexion};
  for (int body = 1; body < hand::kSegmentCount; ++body) {
    joints.phalanx[body].flexion = hand::Dof::kWristFlexion;
  }
  const int first = static_cast<int>(hand::Segment::kIndexProximal);
  for (int k = 0; k < 3; ++k) {
    RollingJoint& joint = joints.phalanx[first + k];
    joint.flexion = dof[k];
    joint.centre = Vec3(0.0, 30.0 * k, 0.0);
    posture[joint.flexion] = 80.0 * geometry::kDegree;
  }
  const auto motion = body_motions(joints, posture);
  for (int k = 0; k < 2; ++k) {
    const Quat& a = motion[first + k].rotation;
    const Quat& b = motion[first + k + 1].rotation;
    EXPECT_NEAR(a.dot(b), std::cos(40.0 * geometry::kDegree), 1e-12);
  }
}

}  // namespace
}  // namespace palmar::phantom
