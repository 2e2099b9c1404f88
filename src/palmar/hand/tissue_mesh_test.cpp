// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::hand {
namespace {

/// A ball of skin, of a finger if so wished, with a ball of bone in it.
Hand ball_hand(Segment segment) {
  Hand hand;
  hand.name = "ball";
  hand.skin = geometry::make_icosphere(12.0, 4);
  const auto count = hand.skin.vertices.size();
  hand.segment.assign(count, segment);
  for (Vec3& x : hand.skin.vertices) x.y() += 20.0;
  for (const Vec3& x : hand.skin.vertices) {
    hand.region.push_back(x.z() > 0.0 ? Region::kIndexDistal : Region::kDorsum);
  }
  Bone& bone = hand.bones.emplace_back();
  bone.mesh = geometry::make_icosphere(5.0, 3);
  for (Vec3& x : bone.mesh.vertices) x.y() += 20.0;
  return hand;
}

TEST(TissueMesh, TissueBetweenTwoSpheresIsMetInVolumeAndSplitByRegion) {
  const Hand hand = ball_hand(Segment::kIndexDistal);
  const TissueMesh tissue = make_tissue_mesh(hand, {.finger_edge = 1.0});
  const double truth = 4.0 / 3.0 * std::numbers::pi * (12.0 * 12.0 * 12.0 - 125.0);
  EXPECT_NEAR(geometry::volume(tissue.mesh), truth, 0.02 * truth);
  const auto by_region = tissue.volume_by_region();
  EXPECT_NEAR(by_region[index_of(Region::kIndexDistal)], 0.5 * truth, 0.04 * truth);
  EXPECT_NEAR(by_region[index_of(Region::kDorsum)], 0.5 * truth, 0.04 * truth);
}

TEST(TissueMesh, EverySkinVertexHangsOnTheSurface) {
  const Hand hand = ball_hand(Segment::kIndexDistal);
  const TissueMesh tissue = make_tissue_mesh(hand, {.finger_edge = 2.0});
  for (const SkinAttachment& at : tissue.attach(hand.skin.vertices)) {
    EXPECT_LT(at.distance, 0.1);
    EXPECT_NEAR(at.weight[0] + at.weight[1] + at.weight[2], 1.0, 1e-12);
    EXPECT_GT(at.edge, 0.9);
    EXPECT_LT(at.edge, 2.2);
  }
}

TEST(TissueMesh, PalmHasElementsTwiceAsLarge) {
  const auto edge_of = [](Segment segment) {
    const Hand hand = ball_hand(segment);
    return make_tissue_mesh(hand, {.finger_edge = 1.5}).attach({Vec3(0.0, 20.0, 12.0)})[0].edge;
  };
  EXPECT_NEAR(edge_of(Segment::kPalm) / edge_of(Segment::kIndexDistal), 2.0, 0.4);
}

TEST(TissueMesh, WhatCannotBeMeshedIsNamed) {
  Hand hand = ball_hand(Segment::kPalm);
  EXPECT_THROW(make_tissue_mesh(hand, {.finger_edge = 0.1}), UsageError);
  hand.bones.clear();
  try {
    make_tissue_mesh(hand);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("hand \"ball\" has no bones"));
  }
}

}  // namespace
}  // namespace palmar::hand
