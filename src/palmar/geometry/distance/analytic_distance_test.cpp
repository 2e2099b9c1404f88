// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/analytic_distance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/grid_distance.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

std::vector<Vec3> random_points(int count, double half, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = half * (generator() / 2147483648.0 - 1.0);
    points.push_back(p);
  }
  return points;
}

/// What every exact distance obeys: the closest point lies on the surface, at the distance
/// reported, and the normal is the gradient.
void expect_is_distance(const DistanceField& field, double half, double kink_share) {
  int off = 0, count = 0;
  for (const Vec3& p : random_points(2000, half, 1)) {
    const DistanceSample s = field.at(p);
    ASSERT_NEAR(s.normal.norm(), 1.0, 1e-9);
    ASSERT_NEAR((p - s.closest).norm(), std::abs(s.distance), 1e-9);
    ASSERT_NEAR(field.at(s.closest).distance, 0.0, 1e-8) << p.transpose();
    Vec3 gradient;
    const double h = 1e-5;
    for (int k = 0; k < 3; ++k) {
      gradient[k] =
          (field.at(p + h * Vec3::Unit(k)).distance - field.at(p - h * Vec3::Unit(k)).distance) /
          (2.0 * h);
    }
    ++count;
    if ((gradient - s.normal).norm() > 1e-4) ++off;
  }
  // The gradient jumps on medial surfaces; few random points are that near to one.
  EXPECT_LE(off, kink_share * count);
}

TEST(AnalyticDistance, IsADistance) {
  expect_is_distance(*make_sphere_distance(20.0), 40.0, 0.001);
  expect_is_distance(*make_cylinder_distance({.radius = 15.0, .length = 50.0}), 40.0, 0.001);
  expect_is_distance(*make_cylinder_distance({.radius = 15.0, .length = 50.0, .edge_radius = 4.0}),
                     40.0, 0.001);
  expect_is_distance(*make_box_distance({30.0, 20.0, 50.0}), 40.0, 0.001);
  expect_is_distance(*make_box_distance({30.0, 20.0, 50.0}, 5.0), 40.0, 0.001);
  expect_is_distance(*make_slab_distance({30.0, 20.0, 10.0}), 40.0, 0.001);
  expect_is_distance(*make_prism_distance({}), 70.0, 0.001);
  expect_is_distance(*make_ellipsoid_distance({30.0, 20.0, 12.0}), 40.0, 0.001);
  expect_is_distance(*make_ellipsoid_distance({2.0, 20.0, 20.0}), 40.0, 0.001);
}

TEST(AnalyticDistance, KnownPlaces) {
  EXPECT_NEAR(make_sphere_distance(20.0)->at({0, 0, 0}).distance, -20.0, 1e-12);
  const auto cylinder = make_cylinder_distance({.radius = 10.0, .length = 40.0});
  EXPECT_NEAR(cylinder->at({13, 0, 24}).distance, 5.0, 1e-12);  // 3-4-5 from the edge
  EXPECT_NEAR(cylinder->at({0, 0, 18}).distance, -2.0, 1e-12);
  EXPECT_NEAR(make_cylinder_distance({.radius = 10.0})->at({0, 4, 1e6}).distance, -6.0, 1e-12);
  EXPECT_LT((cylinder->at({2, 0, 20}).normal - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((cylinder->at({10, 0, 20}).normal - Vec3(1, 0, 1).normalized()).norm(), 1e-12);
  EXPECT_NEAR(make_half_space_distance()->at({3, 4, -2}).distance, -2.0, 1e-12);
  EXPECT_NEAR(make_slab_distance({100, 100, 10})->at({1, 2, 3}).distance, 3.0, 1e-12);
  // Corner of a rounded box: the ball of radius 2 about (8, 8, 8).
  EXPECT_NEAR(make_box_distance({20, 20, 20}, 2.0)->at({11, 11, 11}).distance,
              std::sqrt(27.0) - 2.0, 1e-12);
  // Fillet of a prism: circle of radius 5 about (15, 10).
  EXPECT_NEAR(make_prism_distance({.width = 40, .depth = 30, .length = 100, .fillet_radius = 5})
                  ->at({18, 14, 0})
                  .distance,
              0.0, 1e-12);
}

TEST(AnalyticDistance, EllipsoidOnAxesCentreAndBeyondTheEvolute) {
  const auto e = make_ellipsoid_distance({30.0, 20.0, 10.0});
  EXPECT_NEAR(e->at({37, 0, 0}).distance, 7.0, 1e-10);
  EXPECT_NEAR(e->at({0, 0, -12}).distance, 2.0, 1e-10);
  EXPECT_NEAR(e->at({0, 0, 0}).distance, -10.0, 1e-10);
  EXPECT_NEAR(e->at({29.9, 0, 0}).distance, -0.1, 1e-9);
  // In the x-z section a point (x0, 0) with x0 < (a^2 - c^2) / a has its nearest point at
  // x = a^2 x0 / (a^2 - c^2), off the axis: x0 = 8 gives x = 9, z = 10 sqrt(1 - 0.09), and
  // d^2 = 1 + 91.
  EXPECT_NEAR(e->at({8, 0, 0}).distance, -std::sqrt(92.0), 1e-9);
}

TEST(AnalyticDistance, EllipsoidWithEqualAxesIsTheSphere) {
  const auto e = make_ellipsoid_distance(Vec3::Constant(17.0));
  for (const Vec3& p : random_points(200, 40.0, 2)) {
    EXPECT_NEAR(e->at(p).distance, p.norm() - 17.0, 1e-10);
  }
}

TEST(AnalyticDistance, RefusesSizesThatMakeNoSolid) {
  EXPECT_THROW(make_sphere_distance(0.0), UsageError);
  EXPECT_THROW(make_ellipsoid_distance({1.0, -1.0, 1.0}), UsageError);
  try {
    make_prism_distance({.width = 40, .depth = 8, .length = 100, .fillet_radius = 5});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("fillet radius is 5"));
    EXPECT_THAT(error.what(), testing::HasSubstr("0 to 4"));
  }
}

TEST(GridDistance, IsWithinItsStatedErrorOnSmoothSolids) {
  for (const auto& exact :
       {make_sphere_distance(30.0), make_ellipsoid_distance({40.0, 30.0, 25.0})}) {
    const GridDistance grid(exact);
    const auto points = random_points(20000, 60.0, 3);
    std::vector<DistanceSample> truth(points.size()), found(points.size());
    exact->sample(points, 12.0, truth);
    grid.sample(points, 12.0, found);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(found[i].distance, truth[i].distance, 0.02) << points[i].transpose();
      if (std::abs(truth[i].distance) < 10.0) {
        ASSERT_GT(found[i].normal.dot(truth[i].normal), 0.99);
      }
    }
  }
}

TEST(GridDistance, AsksTheSourceBeyondItsBand) {
  const auto exact = make_sphere_distance(30.0);
  const GridDistance grid(exact);
  EXPECT_NEAR(grid.at({0, 0, 100}).distance, 70.0, 1e-12);
  EXPECT_NEAR(grid.at({0, 0, 0}).distance, -30.0, 1e-12);
}

TEST(GridDistance, AtASharpEdgeIsWithinAQuarterOfTheSpacing) {
  const auto exact = make_box_distance({40.0, 30.0, 60.0});
  const GridDistance grid(exact, {.spacing = 2.0, .band = 10.0});
  for (const Vec3& p : random_points(5000, 45.0, 4)) {
    const double truth = exact->at(p).distance;
    if (std::abs(truth) > 10.0) continue;
    ASSERT_NEAR(grid.at(p).distance, truth, 0.5) << p.transpose();
  }
}

TEST(GridDistance, LeavesSharpEdgesToTheSource) {
  const auto exact = make_box_distance({40.0, 30.0, 60.0});
  const GridDistance grid(exact, {.spacing = 1.5, .band = 10.0, .least_gradient = 0.985});
  // In a cell with nodes on both sides of an edge's bisector the gradient is wrong by
  // 2 sqrt(w (1 - w)) sin(45 deg) at most before it is left to the source.
  for (const Vec3& p : random_points(5000, 45.0, 4)) {
    const double truth = exact->at(p).distance;
    if (std::abs(truth) > 10.0) continue;
    ASSERT_NEAR(grid.at(p).distance, truth, 0.05) << p.transpose();
  }
}

TEST(GridDistance, RefusesASpacingOfZero) {
  EXPECT_THROW(GridDistance(make_sphere_distance(30.0), {.least_gradient = 1.0}), UsageError);
  EXPECT_THROW(GridDistance(make_sphere_distance(30.0), {.spacing = 0.0}), UsageError);
}

}  // namespace
}  // namespace palmar::geometry
