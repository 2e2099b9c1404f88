// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/product/parts/part_triggers.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/product/parts/sdf_mesh_for_test.h"
#include "palmar/product/parts/skeleton_rings.h"

namespace palmar::product {
namespace {

std::vector<Vec3> circle(const Vec3& middle, double radius) {
  std::vector<Vec3> line;
  for (int i = 0; i <= 48; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 48;
    line.push_back(middle + radius * Vec3(std::cos(t), std::sin(t), 0.0));
  }
  return line;
}

Product meshed(const Sdf& sdf, const Box3& box, double spacing) {
  Product product;
  product.name = "made";
  product.mesh = mesh_of(sdf, box, spacing);
  return product;
}

SkeletonEdge line_between(int a, int b, const Vec3& from, const Vec3& to) {
  SkeletonEdge edge;
  edge.node = {a, b};
  edge.point = {from, 0.5 * (from + to), to};
  edge.radius = {1.0, 1.0, 1.0};
  return edge;
}

TEST(SkeletonRings, AreTheShortestIndependentOnes) {
  // Two squares of 10 mm that share a side: their outline, 60 mm round, is the sum of both.
  SkeletonGraph graph;
  graph.node = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {0, 10, 0}, {10, 10, 0}, {20, 10, 0}};
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(3, 4), std::pair(4, 5),
                             std::pair(0, 3), std::pair(1, 4), std::pair(2, 5)}) {
    graph.edges.push_back(line_between(a, b, graph.node[a], graph.node[b]));
  }
  const std::vector<SkeletonRing> rings = rings_of(graph);
  ASSERT_EQ(rings.size(), 2U);  // edges - nodes + 1
  for (const SkeletonRing& ring : rings) {
    EXPECT_NEAR(ring.length, 40.0, 1e-9);
    EXPECT_EQ(ring.point.size(), 8U);
  }
  graph.edges.pop_back();
  graph.edges.pop_back();
  graph.edges.push_back(line_between(2, 5, graph.node[2], graph.node[5]));
  ASSERT_EQ(rings_of(graph).size(), 1U);
  EXPECT_NEAR(rings_of(graph)[0].length, 60.0, 1e-9);
  graph.edges.pop_back();
  EXPECT_TRUE(rings_of(graph).empty());
}

TEST(RingParts, BothRingsOfScissorsAreFoundThoughTheyNearlyTouch) {
  // Rings of 24 and 30 mm inside, of bars 8 mm thick, 2.5 mm apart, on shanks that meet.
  const Vec3 small(-50, 17, 0), large(-50, -20.5, 0);
  const Sdf rings =
      sdf_union(sdf_tube(circle(small, 16.0), 4.0), sdf_tube(circle(large, 19.0), 4.0));
  const Sdf shanks = sdf_union(sdf_tube({Vec3(-35, 12, 0), Vec3(0, 0, 0)}, 4.5),
                               sdf_tube({Vec3(-33, -12, 0), Vec3(0, 0, 0)}, 4.5));
  const Sdf blades = sdf_box(Vec3(40, 0, 0), Vec3(90, 14, 5));
  const Product scissors = meshed(sdf_union(rings, sdf_union(shanks, blades)),
                                  Box3(Vec3(-75, -45, -6), Vec3(86, 38, 6)), 1.6);
  const ProductParts found = find_parts(scissors);
  std::vector<double> discs;
  for (const ProductPart& part : found.parts) {
    if (part.opening) discs.push_back(part.opening->disc);
  }
  std::sort(discs.begin(), discs.end());
  ASSERT_EQ(discs.size(), 2U);
  EXPECT_NEAR(discs[0], 24.0, 0.8);  // mm
  EXPECT_NEAR(discs[1], 30.0, 0.8);
  EXPECT_TRUE(found.triggers.empty());
}

Sdf pistol(bool has_trigger) {
  const Sdf barrel = sdf_box(Vec3(30, 0, 20), Vec3(190, 40, 50));
  const Sdf handle = sdf_tube({Vec3(0, 0, 10), Vec3(0, 0, -95)}, 17.0);
  const Sdf both = sdf_union(barrel, handle);
  return has_trigger ? sdf_union(both, sdf_box(Vec3(21, 0, -24), Vec3(20, 12, 26))) : both;
}

TEST(Triggers, StandBeforeAHandleBelowWhatItCarries) {
  const Box3 box(Vec3(-66, -21, -113), Vec3(126, 21, 46));
  const ProductParts with = find_parts(meshed(pistol(true), box, 2.5));
  ASSERT_EQ(with.triggers.size(), 1U);
  const PartTrigger& trigger = with.triggers[0];
  EXPECT_EQ(with.parts[trigger.part - 1].kind, PartKind::kBar);
  EXPECT_GT(trigger.front.x(), 0.97);
  EXPECT_NEAR(trigger.point.x(), 31.0, 1.5);  // mm; its front
  EXPECT_NEAR(trigger.point.y(), 0.0, 5.0);
  EXPECT_NEAR(trigger.point.z(), -22.0, 4.0);
  EXPECT_NEAR(trigger.reach, 14.0, 2.5);
  EXPECT_TRUE(find_parts(meshed(pistol(false), box, 2.5)).triggers.empty());
}

TEST(Buttons, AreLowOnAFlatFace) {
  const auto on_box = [](double radius, double height) {
    const Sdf housing = sdf_box(Vec3(0, 0, -20), Vec3(90, 70, 40));
    return sdf_union(housing, [=](const Vec3& p) {
      const double side = std::hypot(p.x() - 15.0, p.y() + 5.0) - radius;
      return std::max({side, -2.0 - p.z(), p.z() - height});
    });
  };
  const Box3 box(Vec3(-46, -36, -41), Vec3(46, 36, 26));
  const auto buttons = [&](const Sdf& sdf) {
    const geometry::TriangleMesh mesh = mesh_of(sdf, box, 1.1);
    return buttons_of(mesh, std::vector<int>(mesh.triangles.size(), 0));
  };
  const std::vector<PartButton> found = buttons(on_box(9.0, 5.0));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].width, 18.0, 2.5);  // mm
  EXPECT_NEAR(found[0].height, 5.0, 0.6);
  EXPECT_LT((found[0].point - Vec3(15, -5, 5)).norm(), 1.5);
  EXPECT_GT(found[0].normal.z(), 0.999);
  EXPECT_TRUE(buttons(on_box(9.0, 20.0)).empty()) << "a peg is no button";
  EXPECT_TRUE(buttons(on_box(28.0, 5.0)).empty()) << "a pedestal is no button";
  EXPECT_TRUE(buttons(sdf_box(Vec3(0, 0, -20), Vec3(90, 70, 40))).empty());
}

}  // namespace
}  // namespace palmar::product
