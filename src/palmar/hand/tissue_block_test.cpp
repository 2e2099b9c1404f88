// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::hand {
namespace {

geometry::TriangleMesh ball(double radius, const Vec3& centre, int subdivisions) {
  geometry::TriangleMesh mesh = geometry::make_icosphere(radius, subdivisions);
  for (Vec3& v : mesh.vertices) v += centre;
  return mesh;
}

/// A ball of skin with two balls of bone, the second beyond y = -5; its palmar half is hypothenar.
Hand ball_with_bones() {
  Hand hand;
  hand.name = "ball";
  hand.skin = ball(10.0, Vec3::Zero(), 3);
  for (const Vec3& v : hand.skin.vertices) {
    hand.region.push_back(v.z() > 0.0 ? Region::kHypothenar : Region::kDorsum);
  }
  hand.bones.push_back({.name = "near", .segment = {}, .mesh = ball(3.0, Vec3(0.0, 3.0, 0.0), 2)});
  hand.bones.push_back({.name = "far", .segment = {}, .mesh = ball(1.5, Vec3(0.0, -7.0, 0.0), 2)});
  hand.bones.push_back(
      {.name = "outside", .segment = {}, .mesh = ball(1.0, Vec3(30.0, 5.0, 0.0), 1)});
  return hand;
}

/// Every edge of the triangles is used twice, counting the outlines of the cut face.
void expect_closed(const TissueBlock& block) {
  std::map<std::pair<int, int>, int> use;
  for (const BlockFacet& facet : block.facets) {
    for (const std::vector<int>& loop : facet.loop) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const auto [a, b] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
        ++use[{a, b}];
      }
    }
  }
  for (const auto& [edge, count] : use) {
    EXPECT_EQ(count, 2) << "edge " << edge.first << " " << edge.second;
  }
}

TEST(TissueBlock, CutThroughABoneIsClosedAndHasAHole) {
  const TissueBlock block = make_tissue_block(
      ball_with_bones(), {.region = Region::kHypothenar, .cut_offset = 2.1, .cut_normal = {}});
  expect_closed(block);
  EXPECT_THAT(block.bone, testing::ElementsAre("near"));
  ASSERT_EQ(block.hole.size(), 1u);
  EXPECT_LT((block.hole[0] - Vec3(0.0, 3.0, 0.0)).norm(), 3.0);
  const auto cut = std::find_if(block.facets.begin(), block.facets.end(),
                                [](const auto& f) { return f.face == BlockFace::kCut; });
  ASSERT_NE(cut, block.facets.end());
  EXPECT_EQ(cut->loop.size(), 2u);
  EXPECT_EQ(cut->hole.size(), 1u);
}

TEST(TissueBlock, FacesAreNamedByWhatTheyAre) {
  const Hand hand = ball_with_bones();
  const TissueBlock block = make_tissue_block(
      hand, {.region = Region::kHypothenar, .cut_offset = -20.0, .cut_normal = {}});
  expect_closed(block);
  EXPECT_THAT(block.bone, testing::ElementsAre("near", "far"));
  std::map<BlockFace, int> count;
  for (const BlockFacet& facet : block.facets) {
    ++count[facet.face];
    if (facet.face == BlockFace::kRegion) {
      double height = 0.0;
      for (const int v : facet.loop[0]) height += block.vertices[v].z();
      EXPECT_GT(height, 0.0);
    }
  }
  EXPECT_EQ(count[BlockFace::kCut], 0);
  EXPECT_EQ(count[BlockFace::kSkin] + count[BlockFace::kRegion], hand.skin.triangle_count());
  EXPECT_EQ(count[BlockFace::kBone],
            hand.bones[0].mesh.triangle_count() + hand.bones[1].mesh.triangle_count());
}

TEST(TissueBlock, SaysWhatIsMissing) {
  Hand hand = ball_with_bones();
  EXPECT_THAT(
      [&] {
        make_tissue_block(hand, {.region = Region::kDorsum, .cut_offset = {}, .cut_normal = {}});
      },
      testing::ThrowsMessage<UsageError>(testing::HasSubstr("name a palmar region")));
  EXPECT_THAT(
      [&] {
        make_tissue_block(hand, {.region = Region::kThenar, .cut_offset = {}, .cut_normal = {}});
      },
      testing::ThrowsMessage<UsageError>(testing::HasSubstr("no skin in region thenar")));
  EXPECT_THAT(
      [&] {
        make_tissue_block(hand,
                          {.region = Region::kHypothenar, .cut_offset = 50.0, .cut_normal = {}});
      },
      testing::ThrowsMessage<UsageError>(testing::HasSubstr("leaves nothing of region")));
  hand.bones.clear();
  EXPECT_THAT(
      [&] {
        make_tissue_block(hand,
                          {.region = Region::kHypothenar, .cut_offset = {}, .cut_normal = {}});
      },
      testing::ThrowsMessage<UsageError>(testing::HasSubstr("has no bones")));
}

}  // namespace
}  // namespace palmar::hand
