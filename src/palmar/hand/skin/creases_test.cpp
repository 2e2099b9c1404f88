// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/creases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palmar::hand {
namespace {

using Vec2 = Eigen::Vector2d;

TEST(PlaneCurve, GivesTheSignedDistanceToALine) {
  const PlaneCurve line({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {3.0, 0.0}});
  EXPECT_NEAR(line.signed_distance({1.3, 2.0}), 2.0, 1e-12);  // left of the way
  EXPECT_NEAR(line.signed_distance({1.3, -0.5}), -0.5, 1e-12);
  // Drawn on straight beyond both ends.
  EXPECT_NEAR(line.signed_distance({-50.0, 3.0}), 3.0, 1e-12);
  EXPECT_NEAR(line.signed_distance({80.0, -3.0}), -3.0, 1e-12);
}

TEST(PlaneCurve, FollowsACircle) {
  std::vector<Vec2> points;
  for (int k = 0; k <= 24; ++k) {
    const double angle = std::numbers::pi * k / 24;
    points.emplace_back(20.0 * std::cos(angle), 20.0 * std::sin(angle));
  }
  const PlaneCurve arc(points);
  for (const double angle : {0.5, 1.2, 2.0, 2.7}) {
    const Vec2 direction(std::cos(angle), std::sin(angle));
    // Counter-clockwise travel has the centre on its left. Splines miss a circle by 1e-3 mm here.
    EXPECT_NEAR(arc.signed_distance(15.0 * direction), 5.0, 5e-3);
    EXPECT_NEAR(arc.signed_distance(24.0 * direction), -4.0, 5e-3);
  }
}

TEST(PlaneCurve, KeepsItsSideRoundACorner) {
  const PlaneCurve corner({{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}});
  EXPECT_GT(corner.signed_distance({5.0, 5.0}), 0.0);
  EXPECT_LT(corner.signed_distance({14.0, -4.0}), 0.0);
  EXPECT_LT(corner.signed_distance({20.0, 5.0}), 0.0);
}

TEST(CreasePlane, IsPositiveTowardsTheFingertip) {
  const CreasePlane plane{.point = {0.0, 80.0, 0.0}, .normal = Vec3::UnitY()};
  EXPECT_DOUBLE_EQ(plane.value({5.0, 90.0, -3.0}), 10.0);
  EXPECT_DOUBLE_EQ(plane.value({5.0, 70.0, -3.0}), -10.0);
}

}  // namespace
}  // namespace palmar::hand
