// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/finger_cones.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palmar::grasp {
namespace {

RoundCone cone(const Vec3& a, const Vec3& b, double radius_a, double radius_b) {
  RoundCone result;
  result.a = a;
  result.b = b;
  result.radius_a = radius_a;
  result.radius_b = radius_b;
  return result;
}

TEST(RoundCone, DistanceBesideAndBeyondACylinder) {
  const RoundCone c = cone({0, 0, 0}, {40, 0, 0}, 8.0, 8.0);
  EXPECT_NEAR(distance_to(c, {20, 12, 0}), 4.0, 1e-12);
  EXPECT_NEAR(distance_to(c, {53, 0, 0}), 5.0, 1e-12);
  EXPECT_NEAR(distance_to(c, {20, 0, 0}), -8.0, 1e-12);
}

TEST(RoundCone, TaperedSidesAreTheTangentsOfTheRoundEnds) {
  // Radii 10 and 6, 40 apart: the side leans by asin(0.1) and touches the first ball 1 mm ahead of
  // its centre.
  const RoundCone c = cone({0, 0, 0}, {40, 0, 0}, 10.0, 6.0);
  const double lean = std::sqrt(1.0 - 0.01);
  EXPECT_NEAR(distance_to(c, {1, 10.0 * lean, 0}), 0.0, 1e-12);
  EXPECT_NEAR(distance_to(c, {10, 20, 0}), 20.0 * lean + 0.1 * 10.0 - 10.0, 1e-12);
}

TEST(RoundCone, SlopeOfTheDistanceHasNoKinkAtTheEnds) {
  const RoundCone c = cone({0, 0, 0}, {40, 0, 0}, 10.0, 6.0);
  Vec3 last = distance_from(c, {-10, 15, 2}).away;
  for (double x = -10.0; x <= 55.0; x += 0.1) {
    const Vec3 at(x, 15, 2);
    const ConeDistance here = distance_from(c, at);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = kStep * Vec3::Unit(k);
      EXPECT_NEAR((distance_to(c, at + step) - distance_to(c, at - step)) / (2.0 * kStep),
                  here.away[k], 1e-6)
          << x;
    }
    EXPECT_LT((here.away - last).norm(), 0.02) << x;  // 0.1 mm over at least 6 mm
    last = here.away;
  }
}

TEST(RoundCone, ParallelConesOverlapByTheirRadiiLessTheirGap) {
  const RoundCone p = cone({0, 0, 0}, {40, 0, 0}, 8.0, 8.0);
  const RoundCone q = cone({10, 15, 0}, {50, 15, 0}, 8.0, 8.0);
  EXPECT_NEAR(overlap(p, q), 1.0, 0.01);
}

TEST(RoundCone, CrossingConesOverlapAtTheCrossing) {
  const RoundCone p = cone({-20, 0, 0}, {20, 0, 0}, 8.0, 8.0);
  const RoundCone q = cone({0, -20, 12}, {0, 20, 12}, 8.0, 8.0);
  EXPECT_NEAR(overlap(p, q), 4.0, 0.01);
}

}  // namespace
}  // namespace palmar::grasp
