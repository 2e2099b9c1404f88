// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/opposed_holds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/geometry/mesh/mesh_measures.h"
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

// A hand whose fingers' row points up, its wrist level with the grip, 5 mm above the table at its
// lowest fingertip: that one is 5 mm lower than it should be.
TEST(Standing, TableFeaturesAreWhatTheyAreSaidToBe) {
  HandPoints points;
  points.point = {Vec3(-100, 0, 40), Vec3(0, 20, 40), Vec3(0, 0, 80),
                  Vec3(0, 0, 55),    Vec3(0, 0, 30),  Vec3(0, 0, 5)};
  const Standing table;
  GripFrame frame;
  frame.middle = Vec3(0, 10, 40);
  frame.row = Vec3::UnitZ();
  const TableFeatures features = table_features(points, frame, table);
  EXPECT_NEAR(features[0], 1.0, 1e-12);
  EXPECT_NEAR(features[1], 0.0, 1e-12);
  EXPECT_NEAR(features[2], std::log(1.0 + 5.0 / 20.0), 1e-12);
  const Standing turned = {.up = -Vec3::UnitX(), .table = -500.0};
  frame.middle = Vec3(0, 0, 40);
  EXPECT_NEAR(table_features(points, frame, turned)[1], 1.0, 1e-12);
}

}  // namespace
}  // namespace palmar::grasp
