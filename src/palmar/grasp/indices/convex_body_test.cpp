// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/convex_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

using Point6 = Eigen::Matrix<double, 6, 1>;

PointGroups<6> groups_of(const std::vector<Point6>& points) {
  PointGroups<6> body;
  for (const Point6& p : points) body.group.push_back({p});
  return body;
}

TEST(ConvexBody, CrossPolytopeHasItsDistanceAndVolume) {
  std::vector<Point6> points;
  for (int k = 0; k < 6; ++k) {
    points.push_back(Point6::Unit(k));
    points.push_back(-Point6::Unit(k));
  }
  const BodyMeasures<6> found = measure(groups_of(points));
  EXPECT_TRUE(found.contains_origin);
  EXPECT_TRUE(found.is_distance_exact);
  EXPECT_TRUE(found.is_volume_exact);
  EXPECT_NEAR(found.distance, 1.0 / std::sqrt(6.0), 1e-12);
  EXPECT_NEAR(found.volume, 64.0 / 720.0, 1e-12);  // 2^n / n!
  EXPECT_EQ(found.facets, 64);
}

TEST(ConvexBody, SumOfSegmentsIsACube) {
  // Every facet of the cube is a five-dimensional cube: as far from general position as can be.
  PointGroups<6> body;
  body.is_sum = true;
  for (int k = 0; k < 6; ++k) body.group.push_back({Point6::Unit(k), -Point6::Unit(k)});
  const BodyMeasures<6> found = measure(body);
  EXPECT_NEAR(found.distance, 1.0, 1e-12);
  EXPECT_NEAR(found.volume, 64.0, 1e-9);
  EXPECT_NEAR(found.volume_upper, 64.0, 1e-9);
}

TEST(ConvexBody, SumOfSegmentsInSpaceIsAZonotope) {
  // Volume of a zonotope: sum of |det| over all triples of its segments (Shephard 1974).
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Eigen::Vector3d> segment;
  PointGroups<3> body;
  body.is_sum = true;
  for (int k = 0; k < 7; ++k) {
    segment.emplace_back(unit(random), unit(random), unit(random));
    body.group.push_back({segment.back(), Eigen::Vector3d(-segment.back())});
  }
  double volume = 0.0;
  for (std::size_t a = 0; a < 7; ++a) {
    for (std::size_t b = a + 1; b < 7; ++b) {
      for (std::size_t c = b + 1; c < 7; ++c) {
        Eigen::Matrix3d m;
        m << segment[a], segment[b], segment[c];
        volume += 8.0 * std::abs(m.determinant());
      }
    }
  }
  EXPECT_NEAR(measure(body).volume / volume, 1.0, 1e-9);
}

TEST(ConvexBody, ManyPointsOnASphereApproachTheBall) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  PointGroups<3> body;
  body.group.emplace_back();
  for (int k = 0; k < 4000; ++k) {
    body.group[0].push_back(
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());
  }
  const BodyMeasures<3> found = measure(body);
  const double ball = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_LT(found.volume, ball);
  EXPECT_GT(found.volume, 0.99 * ball);
  EXPECT_EQ(found.facets, 2 * 4000 - 4);  // Euler, all facets triangles
}

TEST(ConvexBody, BoundsHoldWhenFacetsRunOut) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::vector<Point6> points;
  for (int k = 0; k < 60; ++k) {
    Point6 p;
    for (int i = 0; i < 6; ++i) p[i] = normal(random);
    points.push_back(p.normalized());
  }
  const BodyMeasures<6> whole = measure(groups_of(points));
  ASSERT_TRUE(whole.is_volume_exact);
  BodyOptions few;
  few.max_facets = 20;
  few.max_volume_facets = 200;
  const BodyMeasures<6> part = measure(groups_of(points), few);
  EXPECT_FALSE(part.is_volume_exact);
  EXPECT_LE(part.volume, whole.volume);
  EXPECT_GE(part.volume_upper, whole.volume);
  EXPECT_LE(part.distance_lower, whole.distance);
  EXPECT_GE(part.distance, whole.distance);
}

TEST(ConvexBody, FlatBodyNamesItsNormal) {
  std::vector<Point6> points;
  for (int k = 0; k < 5; ++k) {
    points.push_back(Point6::Unit(k));
    points.push_back(-Point6::Unit(k));
  }
  const BodyMeasures<6> found = measure(groups_of(points));
  EXPECT_EQ(found.rank, 5);
  EXPECT_FALSE(found.contains_origin);
  EXPECT_EQ(found.distance, 0.0);
  EXPECT_EQ(found.volume, 0.0);
  EXPECT_NEAR(std::abs(found.weakest[5]), 1.0, 1e-12);
}

TEST(ConvexBody, OriginOnTheBoundaryIsNotInside) {
  // A square pyramid whose base holds the origin.
  PointGroups<3> body;
  body.group = {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}};
  const BodyMeasures<3> found = measure(body);
  EXPECT_EQ(found.rank, 3);
  EXPECT_FALSE(found.contains_origin);
  EXPECT_NEAR(found.weakest.z(), -1.0, 1e-9);
  EXPECT_NEAR(found.volume, 2.0 / 3.0, 1e-12);
}

TEST(ConvexBody, NoPointsNoBody) {
  const BodyMeasures<3> found = measure(PointGroups<3>{});
  EXPECT_EQ(found.rank, 0);
  EXPECT_EQ(found.volume, 0.0);
}

TEST(ConvexBody, RefusesPointsThatAreNotFinite) {
  PointGroups<3> body;
  body.group = {{{1, 0, std::nan("")}}};
  EXPECT_THROW(measure(body), UsageError);
}

}  // namespace
}  // namespace palmar::grasp
