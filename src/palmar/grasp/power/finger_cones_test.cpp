// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/finger_cones.h"

#include <gtest/gtest.h>

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

TEST(RoundCone, RadiusRunsLinearlyFromEndToEnd) {
  const RoundCone c = cone({0, 0, 0}, {40, 0, 0}, 10.0, 6.0);
  EXPECT_NEAR(distance_to(c, {10, 20, 0}), 11.0, 1e-12);
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
