// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/opposed_holds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/holds/hold_weights.h"
#include "palmar/product/primitives.h"

namespace palmar::grasp {
namespace {

TEST(Standing, IsOnItsLowestPoint) {
  const geometry::TriangleMesh mesh =
      product::make_prism_product({.width = 60.0, .depth = 20.0, .length = 100.0}).mesh;
  const Standing standing = standing_with(mesh, Vec3(0.0, 0.0, -2.0));
  EXPECT_EQ(standing.up, Vec3(0.0, 0.0, -1.0));
  EXPECT_NEAR(standing.table, -geometry::bounding_box(mesh).max().z(), 1e-9);
}

// A palm that faces sideways, its thumb's side up and its lower knuckle 10 mm above the table: 5 mm
// lower than a hand's back lets it be.
TEST(Standing, TableFeaturesAreWhatTheyAreSaidToBe) {
  PalmPlace palm;
  palm.wrist = Vec3(-90, 0, 40);
  palm.index_knuckle = Vec3(0, 0, 70);
  palm.little_knuckle = Vec3(0, 0, 10);
  palm.faces = Vec3::UnitY();
  palm.thumb_side = Vec3::UnitZ();
  const Standing table;
  const TableFeatures features = table_features(palm, table);
  EXPECT_NEAR(features[0], 1.0, 1e-12);
  EXPECT_NEAR(features[1], 0.0, 1e-12);
  EXPECT_NEAR(features[2], std::log(1.0 + 5.0 / 20.0), 1e-12);
  const Standing turned = {.up = -Vec3::UnitY(), .table = -500.0};
  EXPECT_NEAR(table_features(palm, turned)[1], 1.0, 1e-12);
}

// The built-in weights say what people do at a table: the thumb's side not down, the palm not up,
// the hand not in the table.
TEST(Standing, BuiltInWeightsHaveTheSignsOfAHandAtATable) {
  const TableFeatures slope = hand_over_weights().table_slope();
  EXPECT_GT(slope[0], 1.0);
  EXPECT_GT(slope[1], 1.0);
  EXPECT_LT(slope[2], -0.5);
}

// Of both hands of the template: the index finger's knuckle is on the thumb's side.
TEST(Standing, PalmPlaceFollowsTheSideOfTheHand) {
  for (const hand::Side side : {hand::Side::kRight, hand::Side::kLeft}) {
    hand::Hand hand;
    hand.side = side;
    const double thumb = side == hand::Side::kRight ? 1.0 : -1.0;
    hand.skeleton.joints[index_of(hand::JointId::kIndexMcp)].centre = Vec3(thumb * 20.0, 90.0, 0.0);
    hand.skeleton.joints[index_of(hand::JointId::kLittleMcp)].centre =
        Vec3(thumb * -40.0, 75.0, 0.0);
    const Quat turn(Eigen::AngleAxisd(0.7, Vec3(0.6, 0.0, 0.8)));
    const PalmPlace palm = palm_place(hand, {turn, Vec3(10.0, 20.0, 30.0)});
    EXPECT_GT((palm.index_knuckle - palm.little_knuckle).dot(palm.thumb_side), 59.0);
    EXPECT_NEAR((palm.faces - turn * Vec3::UnitZ()).norm(), 0.0, 1e-12);
    EXPECT_NEAR((palm.wrist - Vec3(10.0, 20.0, 30.0)).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace palmar::grasp
