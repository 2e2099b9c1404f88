// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/convex_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palmar::geometry {
namespace {

using Points = std::vector<Eigen::Vector2d>;

TEST(ConvexHull, CornersGoRoundCounterClockwiseFromTheLeft) {
  // A square with points on its edges and in it, in no order, one twice.
  const Points points = {{2, 2}, {0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {2, 1}, {0, 0}, {0, 1}};
  EXPECT_EQ(convex_hull(points), (Points{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
}

TEST(ConvexHull, OfACircleIsAllOfItsPoints) {
  Points points;
  for (int k = 0; k < 60; ++k) {
    const double a = 2.0 * std::numbers::pi * (7 * k % 60) / 60.0;
    points.emplace_back(3.0 + std::cos(a), std::sin(a) - 2.0);
  }
  const Points hull = convex_hull(points);
  ASSERT_EQ(hull.size(), 60U);
  double length = 0.0;
  for (std::size_t i = 0; i < 60; ++i) length += (hull[(i + 1) % 60] - hull[i]).norm();
  // A regular polygon of 60 sides in a circle of radius 1.
  EXPECT_NEAR(length, 120.0 * std::sin(std::numbers::pi / 60.0), 1e-9);
}

TEST(ConvexHull, OfALineIsItsEnds) {
  EXPECT_EQ(convex_hull({{1, 1}, {3, 3}, {0, 0}, {2, 2}}), (Points{{0, 0}, {3, 3}}));
  EXPECT_EQ(convex_hull({{1, 1}, {1, 1}}), (Points{{1, 1}}));
  EXPECT_TRUE(convex_hull({}).empty());
}

}  // namespace
}  // namespace palmar::geometry
