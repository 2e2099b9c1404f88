// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/gloved.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/product/primitives.h"

namespace palmar::product {
namespace {

std::vector<Vec3> points_round(double size) {
  RandomStream random(3, 0);
  std::vector<Vec3> points;
  for (int k = 0; k < 500; ++k) {
    const auto coordinate = [&] { return size * (2.0 * random.uniform() - 1.0); };
    const double x = coordinate(), y = coordinate(), z = coordinate();
    points.emplace_back(x, y, z);
  }
  return points;
}

// A cylinder of radius 20 in a glove of 3 mm is a cylinder of radius 23, away from its ends.
TEST(Gloved, CylinderIsOneOfLargerRadius) {
  const Product inner = make_cylinder_product({.diameter = 40.0, .length = 400.0});
  const Product outer = gloved(inner, 3.0);
  const geometry::DistanceFieldPtr truth =
      geometry::make_cylinder_distance({.radius = 23.0, .length = 406.0});
  for (const Vec3& point : points_round(50.0)) {
    const geometry::DistanceSample ours = outer.distance->at(point), theirs = truth->at(point);
    EXPECT_NEAR(ours.distance, theirs.distance, 1e-9);
    if (point.head<2>().norm() < 1e-3) continue;  // on the axis every direction is nearest
    EXPECT_NEAR((ours.closest - theirs.closest).norm(), 0.0, 1e-9);
    EXPECT_NEAR((ours.normal - theirs.normal).norm(), 0.0, 1e-9);
  }
  for (const Vec3& vertex : outer.mesh.vertices) {
    if (std::abs(vertex.z()) > 190.0) continue;  // the ends' sharp edge
    EXPECT_NEAR(vertex.head<2>().norm(), 23.0, 1e-9);
  }
  EXPECT_NEAR(outer.distance->bounding_box().max().x(), 23.0, 1e-9);
}

// With a range, far points come back as far and near ones as without; a mesh asked again from what
// it said before answers the same.
TEST(Gloved, RangeAndMemoryDontChangeTheAnswer) {
  const Product sphere = make_sphere_product({.diameter = 40.0});
  Product meshed = sphere;
  meshed.distance = std::make_shared<geometry::MeshDistance>(sphere.mesh);
  const Product grown = gloved(meshed, 2.0);
  const std::vector<Vec3> points = points_round(30.0);
  std::vector<geometry::DistanceSample> samples(points.size());
  constexpr double kRange = 4.0;
  grown.distance->sample(points, kRange, samples);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const geometry::DistanceSample whole = grown.distance->at(points[i]);
    if (std::abs(whole.distance) < kRange) {
      EXPECT_NEAR(samples[i].distance, whole.distance, 1e-9);
    } else {
      EXPECT_EQ(samples[i].distance, std::copysign(kRange, whole.distance));
      EXPECT_EQ(samples[i].triangle, -1);
    }
  }
  std::vector<Vec3> moved = points;
  for (Vec3& point : moved) point += Vec3(0.1, -0.2, 0.05);
  std::vector<geometry::DistanceSample> again(moved.size());
  grown.distance->sample(moved, kRange, again);
  grown.distance->resample(moved, kRange, samples);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    EXPECT_NEAR(samples[i].distance, again[i].distance, 1e-12);
    EXPECT_NEAR((samples[i].closest - again[i].closest).norm(), 0.0, 1e-9);
  }
}

TEST(Gloved, RefusesAThicknessThatIsNoGlove) {
  const Product sphere = make_sphere_product({.diameter = 40.0});
  EXPECT_EQ(gloved(sphere, 0.0).distance, sphere.distance);
  try {
    gloved(sphere, -1.0);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("-1 mm; 0 to 20 mm is allowed"));
  }
}

}  // namespace
}  // namespace palmar::product
