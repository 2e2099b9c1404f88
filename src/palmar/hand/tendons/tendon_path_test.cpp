// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/tendon_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using effort_test::kFingers;
using effort_test::plain_hand;

/// One hinge about x through the origin, turned by `angle`; body 1 moves.
PosedDigit hinge_digit(double angle) {
  PosedDigit digit;
  digit.body[1].rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitX()));
  digit.twist[0] = {Vec3::UnitX(), Vec3::Zero()};
  digit.moves = {1, 9, 9, 9};
  return digit;
}

TEST(TendonPath, StraightLineHasTheLeverOfItsDistanceFromTheAxis) {
  // In the y, z plane from (-10, 3) to (10, 3): 3 mm palmar of the axis, so the tendon flexes (y to
  // z) with 3 mm.
  const TendonPath path = {{{0, Vec3(0, -10, 3)}, {1, Vec3(0, 10, 3)}, std::nullopt, 1.0}};
  const PosedDigit digit = hinge_digit(0.0);
  EXPECT_NEAR(path_length(path, digit), 20.0, 1e-12);
  EXPECT_NEAR(moment_arms(path, digit)[0], 3.0, 1e-12);
  EXPECT_EQ(moment_arms(path, digit)[1], 0.0);
}

TEST(TendonPath, ShareScalesLengthAndArm) {
  TendonPath path = {{{0, Vec3(0, -10, 3)}, {1, Vec3(0, 10, 3)}, std::nullopt, 0.25}};
  EXPECT_NEAR(moment_arms(path, hinge_digit(0.3))[0],
              0.25 * moment_arms({{path[0].proximal, path[0].distal, std::nullopt, 1.0}},
                                 hinge_digit(0.3))[0],
              1e-12);
}

/// An extensor over a joint: it runs along the dorsal side (z < 0), tangent to the cylinder in the
/// straight finger.
TendonPath extensor(double x_offset) {
  return {{{0, Vec3(0, -12, -5)},
           {1, Vec3(x_offset, 12, -5)},
           TendonCylinder{0, Vec3::Zero(), Vec3::UnitX(), 5.0, 1.0},
           1.0}};
}

TEST(TendonPath, WrappedTendonIsTangentsAndArc) {
  // Both ends lie 12 mm from the touching points; turning by theta adds an arc of 5 theta.
  for (const double theta : {0.1, 0.5, 1.0, 1.8}) {
    const PosedDigit digit = hinge_digit(theta);
    EXPECT_NEAR(path_length(extensor(0.0), digit), 24.0 + 5.0 * theta, 1e-12);
    EXPECT_NEAR(moment_arms(extensor(0.0), digit)[0], -5.0, 1e-12);
  }
}

TEST(TendonPath, ExtensorLeavesTheCylinderInExtension) {
  const double theta = -0.4;
  const PosedDigit digit = hinge_digit(theta);
  // The chord between the ends, and its distance from the axis.
  EXPECT_NEAR(path_length(extensor(0.0), digit), 2.0 * 13.0 * std::sin(std::atan(12.0 / 5.0) - 0.2),
              1e-12);
  EXPECT_NEAR(moment_arms(extensor(0.0), digit)[0], -13.0 * std::cos(std::atan(12.0 / 5.0) - 0.2),
              1e-12);
}

TEST(TendonPath, FlexorKeepsItsLargestArmInDeepFlexion) {
  // Points 5 and 10 mm from the axis: the chord's arm grows to 5 mm where it is perpendicular to
  // the shorter one, at an angle of acos(5 / 10) = 60 degrees between them, 120 degrees of flexion
  // from opposite.
  const TendonPath path = {{{0, Vec3(0, -10, 0)},
                            {1, Vec3(0, 5, 0)},
                            TendonCylinder{0, Vec3::Zero(), Vec3::UnitX(), 1.0, -1.0},
                            1.0}};
  const double length = std::sqrt(75.0);  // of the chord there
  EXPECT_NEAR(path_length(path, hinge_digit(120.0 * geometry::kDegree)), length, 1e-9);
  EXPECT_NEAR(moment_arms(path, hinge_digit(119.9 * geometry::kDegree))[0], 5.0, 1e-4);
  EXPECT_NEAR(moment_arms(path, hinge_digit(150.0 * geometry::kDegree))[0], 5.0, 1e-12);
  EXPECT_NEAR(path_length(path, hinge_digit(150.0 * geometry::kDegree)),
              length - 5.0 * 30.0 * geometry::kDegree, 1e-9);
}

TEST(TendonPath, RunsAsAHelixAcrossTheCylinder) {
  const double theta = 0.8;
  EXPECT_NEAR(path_length(extensor(6.0), hinge_digit(theta)), std::hypot(24.0 + 5.0 * theta, 6.0),
              1e-12);
}

TEST(TendonPath, MomentArmsAreTheDerivativeOfTheLength) {
  const Hand hand = plain_hand();
  std::mt19937 random(7);
  constexpr double kStep = 1e-5;  // rad; truncation about 1e-9 mm, rounding about 1e-10
  for (const Finger finger : kFingers) {
    const DigitTendons tendons = route_tendons(hand, finger);
    for (int sample = 0; sample < 40; ++sample) {
      const Posture posture = effort_test::random_posture(hand.skeleton, finger, random);
      const PosedDigit digit = pose_digit(hand.skeleton, finger, posture);
      const auto arms = moment_arms(tendons, digit);
      for (std::size_t t = 0; t < tendons.path.size(); ++t) {
        for (std::size_t k = 0; k < kDigitDofs; ++k) {
          Posture plus = posture, minus = posture;
          plus[digit.dof[k]] += kStep;
          minus[digit.dof[k]] -= kStep;
          const double numeric =
              -(path_length(tendons.path[t], pose_digit(hand.skeleton, finger, plus)) -
                path_length(tendons.path[t], pose_digit(hand.skeleton, finger, minus))) /
              (2.0 * kStep);
          EXPECT_NEAR(arms[t][k], numeric, 1e-5)
              << name_of(finger) << " " << name_of(tendons_of(finger)[t]) << " "
              << name_of(digit.dof[k]);
        }
      }
    }
  }
}

TEST(DigitPose, BodiesAreThoseOfTheSkeleton) {
  const Hand hand = plain_hand();
  std::mt19937 random(3);
  for (const Finger finger : kFingers) {
    const Posture posture = effort_test::random_posture(hand.skeleton, finger, random);
    const PosedDigit digit = pose_digit(hand.skeleton, finger, posture);
    const PosedSkeleton posed = pose_skeleton(hand.skeleton, posture);
    const Vec3 probe(10, 20, 30);
    for (const auto& segment : segments_of(finger)) {
      if (!segment) continue;
      EXPECT_LT((digit.place(body_of(*segment), probe) - posed.segment[index_of(*segment)] * probe)
                    .norm(),
                1e-10)
          << name_of(*segment);
    }
    if (finger == Finger::kThumb) {
      EXPECT_LT((digit.place(1, probe) - posed.thumb_metacarpal * probe).norm(), 1e-10);
    }
  }
}

TEST(DigitPose, TwistsAreTheRatesOfPoints) {
  const Hand hand = plain_hand();
  std::mt19937 random(5);
  constexpr double kStep = 1e-5;
  for (const Finger finger : kFingers) {
    const Posture posture = effort_test::random_posture(hand.skeleton, finger, random);
    const PosedDigit digit = pose_digit(hand.skeleton, finger, posture);
    const Vec3 probe(5, 100, 8);
    for (int body = 0; body < body_count(finger); ++body) {
      for (int k = 0; k < kDigitDofs; ++k) {
        Posture plus = posture, minus = posture;
        plus[digit.dof[k]] += kStep;
        minus[digit.dof[k]] -= kStep;
        const Vec3 numeric = (pose_digit(hand.skeleton, finger, plus).place(body, probe) -
                              pose_digit(hand.skeleton, finger, minus).place(body, probe)) /
                             (2.0 * kStep);
        EXPECT_LT((digit.velocity(k, body, digit.place(body, probe)) - numeric).norm(), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace palmar::hand
