// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/grip_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palmar::grasp {
namespace {

TEST(GripForce, OfTwoOpposedFingersIsTheirForce) {
  const Vec3 along = Vec3(1.0, -2.0, 0.5).normalized();
  const Squeeze grip = grip_force({7.0 * along, -7.0 * along});
  EXPECT_NEAR(grip.force, 7.0, 1e-12);
  EXPECT_NEAR(grip.sum_of_normals, 14.0, 1e-12);
  EXPECT_NEAR(std::abs(grip.across.dot(along)), 1.0, 1e-9);
}

TEST(GripForce, OfEvenPressureRoundACylinderIsTheSumOverPi) {
  std::vector<Vec3> forces;
  constexpr int kCount = 720;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCount;
    forces.emplace_back(0.0, std::cos(angle), std::sin(angle));
  }
  const Squeeze grip = grip_force(forces);
  EXPECT_NEAR(grip.sum_of_normals / grip.force, std::numbers::pi, 1e-4);
}

TEST(GripForce, OfThreeJawsIsThatOfOneJaw) {
  // Across one jaw: (1 + 1/2 + 1/2) / 2; perpendicular to it only 2 (sqrt 3 / 2) / 2.
  std::vector<Vec3> forces;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 3.0 + 0.3;
    forces.emplace_back(5.0 * std::cos(angle), 5.0 * std::sin(angle), 0.0);
  }
  const Squeeze grip = grip_force(forces);
  EXPECT_NEAR(grip.force, 5.0, 1e-9);
}

TEST(GripForce, FindsTheLargestOfManyDirections) {
  // Against a search over directions a degree apart.
  std::vector<Vec3> forces;
  for (int i = 0; i < 17; ++i) {
    forces.emplace_back(std::sin(1.3 * i), std::cos(2.1 * i + 0.4), std::sin(0.7 * i * i));
  }
  double most = 0.0;
  for (int a = 0; a < 180; ++a) {
    for (int b = 0; b < 180; ++b) {
      const double rise = std::numbers::pi * a / 180.0, turn = std::numbers::pi * b / 180.0;
      const Vec3 e(std::sin(rise) * std::cos(turn), std::sin(rise) * std::sin(turn),
                   std::cos(rise));
      double sum = 0.0;
      for (const Vec3& f : forces) sum += 0.5 * std::abs(f.dot(e));
      most = std::max(most, sum);
    }
  }
  const Squeeze grip = grip_force(forces);
  EXPECT_GE(grip.force, most);
  EXPECT_LT(grip.force, 1.001 * most);
}

TEST(GripForce, OfNothingIsNothing) {
  EXPECT_EQ(grip_force(std::vector<Vec3>{}).force, 0.0);
  EXPECT_EQ(grip_force(std::vector<Vec3>{}).sum_of_normals, 0.0);
}

}  // namespace
}  // namespace palmar::grasp
