// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/grip_choice.h"

#include <gtest/gtest.h>

#include <numbers>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::grasp {
namespace {

geometry::TriangleMesh ellipsoid(const Vec3& diameters) {
  geometry::TriangleMesh mesh = geometry::make_icosphere(0.5, 4);
  for (Vec3& v : mesh.vertices) v = v.cwiseProduct(diameters);
  return mesh;
}

TEST(BodyShape, ABallFillsPiSixthsOfItsBox) {
  const BodyShape shape = body_shape(ellipsoid({70.0, 70.0, 70.0}));
  EXPECT_NEAR(shape.fill, std::numbers::pi / 6.0, 0.01);  // a facetted ball is a little smaller
  EXPECT_NEAR(shape.extent.maxCoeff(), 70.0, 0.5);
  EXPECT_LT(shape.centre.norm(), 1e-6);
}

TEST(BodyShape, EggsAreBallsAndCubesAndRodsAreNot) {
  EXPECT_TRUE(is_ball_like(body_shape(ellipsoid({70.0, 65.0, 60.0}))));
  EXPECT_FALSE(is_ball_like(body_shape(ellipsoid({70.0, 70.0, 140.0}))));
  EXPECT_FALSE(is_ball_like(body_shape(geometry::make_box({60.0, 60.0, 60.0}, 2))));
  EXPECT_FALSE(is_ball_like(body_shape(geometry::make_box({60.0, 60.0, 5.0}, 2))));
  EXPECT_FALSE(is_ball_like(body_shape(geometry::TriangleMesh{})));
}

TEST(WrapFor, ThreeWrapsInTheOrderOfSize) {
  const double length = 184.0;
  const auto wrap = [&](double diameter) { return wrap_for(std::numbers::pi * diameter, length); };
  EXPECT_EQ(wrap(20.0), Grip::kSmallDiameter);
  EXPECT_EQ(wrap(40.0), Grip::kMediumWrap);
  EXPECT_EQ(wrap(80.0), Grip::kLargeDiameter);
  // Sizes are of the hand: what is medium for a man is large for a child.
  EXPECT_EQ(wrap_for(std::numbers::pi * 55.0, 130.0), Grip::kLargeDiameter);
}

TEST(BallSites, GoThroughTheMiddleInThreeDirections) {
  const geometry::TriangleMesh mesh = ellipsoid({80.0, 72.0, 64.0});
  const std::vector<GripSite> sites = ball_sites(mesh, body_shape(mesh));
  ASSERT_EQ(sites.size(), 3u);
  for (const GripSite& site : sites) {
    EXPECT_LT(site.point.norm(), 2.0);
    EXPECT_GT(site.girth, std::numbers::pi * 62.0);
    EXPECT_LT(site.girth, std::numbers::pi * 80.0);
  }
  EXPECT_LT(std::abs(sites[0].axis.dot(sites[1].axis)), 1e-6);
}

}  // namespace
}  // namespace palmar::grasp
