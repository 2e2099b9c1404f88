// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/layer_thickness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

/// One vertex of skin at the origin that looks down on a bone below it.
hand::Hand over_bone(geometry::TriangleMesh bone) {
  hand::Hand hand;
  hand.bones.push_back({.name = "bone", .segment = {}, .mesh = std::move(bone)});
  return hand;
}

SkinGeometry one_vertex() {
  SkinGeometry skin;
  skin.position = {Vec3::Zero()};
  skin.normal = {Vec3::UnitZ()};
  return skin;
}

TEST(EffectiveLayerThickness, OfFlatBoneIsItsDepth) {
  geometry::TriangleMesh plate;
  plate.vertices = {Vec3(-2e3, -2e3, -4.0), Vec3(2e3, -2e3, -4.0), Vec3(2e3, 2e3, -4.0),
                    Vec3(-2e3, 2e3, -4.0)};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  // Bone farther than 40 mm away adds nothing: a share of (4 / 40)^2 of the view.
  EXPECT_NEAR(effective_layer_thickness(over_bone(plate), one_vertex())[0], 4.0, 0.03);
}

TEST(EffectiveLayerThickness, OfABallOfBoneIsThatOfItsView) {
  // Ball of radius b, centre D below: a ray at the angle t, sin t < b / D, goes
  // L = D cos t - sqrt(b^2 - D^2 sin^2 t). 1 / h^2 = Int 2 sin t cos t / (L cos t)^2 dt.
  constexpr double kRadius = 3.0;
  constexpr double kDepth = 7.0;
  geometry::TriangleMesh ball = geometry::make_icosphere(kRadius, 5);
  for (Vec3& v : ball.vertices) v.z() -= kDepth;
  double sum = 0.0;
  constexpr int kSteps = 100000;
  const double end = std::asin(kRadius / kDepth);
  for (int k = 0; k < kSteps; ++k) {
    const double t = end * (k + 0.5) / kSteps;
    const double s = std::sin(t);
    const double c = std::cos(t);
    const double way = kDepth * c - std::sqrt(kRadius * kRadius - kDepth * kDepth * s * s);
    sum += 2.0 * s * c / (way * way * c * c) * end / kSteps;
  }
  const double expected = 1.0 / std::sqrt(sum);
  EXPECT_GT(expected, 2.0 * (kDepth - kRadius));  // a small ball holds far less than a plate
  // 96 directions, of which a fifth meets the ball: one more or less is 3 % of h.
  EXPECT_NEAR(effective_layer_thickness(over_bone(ball), one_vertex())[0], expected,
              0.04 * expected);
}

TEST(EffectiveLayerThickness, WithoutBoneIsTheMost) {
  EXPECT_EQ(effective_layer_thickness(hand::Hand(), one_vertex())[0], kMostLayerThickness);
  geometry::TriangleMesh behind = geometry::make_icosphere(3.0, 2);
  for (Vec3& v : behind.vertices) v.z() += 10.0;  // on the outer side of the skin
  EXPECT_EQ(effective_layer_thickness(over_bone(behind), one_vertex())[0], kMostLayerThickness);
}

}  // namespace
}  // namespace palmar::contact
