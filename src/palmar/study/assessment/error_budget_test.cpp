// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/error_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::study {
namespace {

TEST(SplitSkin, KeepsTheSurfaceAndItsRegions) {
  hand::Hand hand;
  hand.name = "ball";
  hand.skin = geometry::make_icosphere(30.0, 2);
  for (const Vec3& v : hand.skin.vertices) {
    hand.region.push_back(v.z() < 0.0 ? hand::Region::kThenar : hand::Region::kDorsum);
  }
  hand.segment.assign(hand.region.size(), hand::Segment::kPalm);
  // Posed: twice as large and moved.
  std::vector<Vec3> posed;
  for (const Vec3& v : hand.skin.vertices) posed.emplace_back(2.0 * v + Vec3(5, 0, 0));
  const int vertices = hand.skin.vertex_count();
  const int triangles = hand.skin.triangle_count();

  const hand::Hand fine = split_skin(hand, posed);
  EXPECT_EQ(fine.skin.triangle_count(), 4 * triangles);
  EXPECT_EQ(fine.skin.vertex_count(), vertices + 3 * triangles / 2);  // one more for each edge
  EXPECT_NEAR(geometry::surface_area(fine.skin), geometry::surface_area(hand.skin),
              1e-9 * geometry::surface_area(hand.skin));
  ASSERT_EQ(posed.size(), fine.skin.vertices.size());
  ASSERT_EQ(fine.region.size(), posed.size());
  for (std::size_t v = 0; v < posed.size(); ++v) {
    EXPECT_LT((posed[v] - (2.0 * fine.skin.vertices[v] + Vec3(5, 0, 0))).norm(), 1e-9);
  }
  for (int v = 0; v < vertices; ++v) EXPECT_EQ(fine.region[v], hand.region[v]);
}

}  // namespace
}  // namespace palmar::study
