// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/skin_product.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/geometry/distance/grid_distance.h"
#include "palmar/geometry/distance/mesh_distance.h"

namespace palmar::contact {
namespace {

using contact_test::Ball;
using contact_test::ball_hand;

void expect_same(const SkinOnProduct& found, const SkinOnProduct& truth, int step) {
  ASSERT_EQ(found.sample.size(), truth.sample.size());
  for (std::size_t v = 0; v < truth.sample.size(); ++v) {
    ASSERT_EQ(found.sample[v].distance, truth.sample[v].distance) << "step " << step << " " << v;
    ASSERT_EQ(found.sample[v].closest, truth.sample[v].closest) << "step " << step << " " << v;
    ASSERT_EQ(found.sample[v].normal, truth.sample[v].normal) << "step " << step << " " << v;
    ASSERT_EQ(found.sample[v].triangle, truth.sample[v].triangle) << "step " << step << " " << v;
  }
  EXPECT_EQ(found.near, truth.near);
  EXPECT_EQ(found.collision, truth.collision);
  EXPECT_EQ(found.left_out, truth.left_out);
  EXPECT_EQ(found.traced, truth.traced);
  EXPECT_EQ(found.is_too_deep, truth.is_too_deep);
  EXPECT_EQ(found.message, truth.message);
}

/// A ball of skin that comes down on the product, sideways, in steps from small to large.
void expect_same_along_motion(const geometry::DistanceField& product) {
  const auto hand = ball_hand(15.0, 3);
  SkinSampler sampler;
  SkinOnProduct found;
  double height = 45.0;  // mm
  for (int step = 0; step < 30; ++step) {
    height -= step % 7 == 6 ? 4.0 : 0.3 + 0.05 * step;
    std::vector<Vec3> posed = hand->skin.vertices;
    for (Vec3& x : posed) x += Vec3(0.2 * step, 3.0, height);
    find_skin_on_product(*hand, posed, product, std::nullopt, &sampler, found);
    expect_same(found, find_skin_on_product(*hand, posed, product, std::nullopt), step);
  }
  EXPECT_FALSE(found.collision.empty() && found.left_out.empty());
}

TEST(SkinSampler, SaysTheSameAlongAMotionOverAClosedMesh) {
  expect_same_along_motion(geometry::MeshDistance(geometry::make_icosphere(20.0, 4)));
}

TEST(SkinSampler, SaysTheSameWhereTheSideJumpsInAHole) {
  // Without its upper half the mesh has a hole through which the side changes far from any surface.
  geometry::TriangleMesh bowl = geometry::make_icosphere(20.0, 4);
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return bowl.vertices[t[0]].z() > 8.0 && bowl.vertices[t[1]].z() > 8.0;
  });
  const geometry::MeshDistance field(bowl);
  ASSERT_FALSE(field.is_lipschitz());
  expect_same_along_motion(field);
}

TEST(SkinSampler, SaysTheSameOfInterpolatedAndAnalyticFields) {
  expect_same_along_motion(geometry::GridDistance(
      std::make_shared<const geometry::MeshDistance>(geometry::make_icosphere(20.0, 4))));
  expect_same_along_motion(Ball(Vec3::Zero(), 20.0));
}

TEST(SkinSampler, ForgetsAnotherProduct) {
  const auto hand = ball_hand(15.0, 2);
  std::vector<Vec3> posed = hand->skin.vertices;
  for (Vec3& x : posed) x.z() += 40.0;
  SkinSampler sampler;
  SkinOnProduct found;
  // The second is made where the first was, so its address shows nothing.
  auto product = std::make_unique<geometry::MeshDistance>(geometry::make_icosphere(10.0, 3));
  find_skin_on_product(*hand, posed, *product, std::nullopt, &sampler, found);
  EXPECT_TRUE(found.collision.empty());
  const std::uint64_t first = product->id();
  product.reset();
  product = std::make_unique<geometry::MeshDistance>(geometry::make_icosphere(30.0, 3));
  EXPECT_NE(product->id(), first);
  find_skin_on_product(*hand, posed, *product, std::nullopt, &sampler, found);
  EXPECT_FALSE(found.collision.empty());
  expect_same(found, find_skin_on_product(*hand, posed, *product, std::nullopt), 0);
}

TEST(SkinSampler, LetsOtherRegionsThrough) {
  const auto hand = ball_hand(15.0, 2);
  const geometry::MeshDistance product(geometry::make_icosphere(20.0, 3));
  std::vector<Vec3> posed = hand->skin.vertices;
  for (Vec3& x : posed) x.z() += 33.0;
  SkinSampler sampler;
  SkinOnProduct found;
  for (const std::optional<hand::Region> only :
       {std::optional<hand::Region>(), std::optional(hand::Region::kDorsum),
        std::optional(hand::Region::kMiddleDistal), std::optional<hand::Region>()}) {
    find_skin_on_product(*hand, posed, product, only, &sampler, found);
    expect_same(found, find_skin_on_product(*hand, posed, product, only), 0);
  }
}

}  // namespace
}  // namespace palmar::contact
