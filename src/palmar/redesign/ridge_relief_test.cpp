// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/ridge_relief.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/product/primitives.h"
#include "palmar/redesign/handle_section.h"
#include "palmar/study/study_record.h"

namespace palmar::redesign {
namespace {

const double kCorner = std::sqrt(2.0) - 1.0;  // how far a square's corner stands off its circle

product::Product prism() {
  return product::make_prism_product(
      {.width = 35.0, .depth = 35.0, .length = 130.0, .fillet_radius = 3.0});
}

/// Ten of ten hands touch where `where` says so, and their imprint is `depth`.
struct Situation {
  geometry::TriangleMesh map;
  ContactRegion region;
  std::vector<double> imprint;
};
template <typename Where, typename Depth>
Situation situation(const product::Product& product, const Where& where, const Depth& depth) {
  Situation s{study::product_map(product.mesh), {}, {}};
  ContactCount count = start_count(s.map);
  count.hands = 10;
  for (std::size_t v = 0; v < s.map.vertices.size(); ++v) {
    if (where(s.map.vertices[v])) count.any[v] = 10;
    s.imprint.push_back(depth(s.map.vertices[v]));
  }
  s.region = contact_region(s.map, count);
  return s;
}

TEST(HandleSection, SeatsADiscInTheCornerOfAPrism) {
  const HandleSection section(prism().mesh, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(),
                              Vec3::UnitY());
  EXPECT_NEAR(section.largest_disc(), 17.5, 0.02);
  const auto ridges = section.ridges(14.0);
  ASSERT_EQ(ridges.size(), 4U);
  for (const SectionRidge& ridge : ridges) {
    // The tip of the fillet of 3 mm.
    EXPECT_NEAR(ridge.apex.norm(), 14.5 * std::sqrt(2.0) + 3.0, 0.03);
    EXPECT_NEAR(std::abs(ridge.apex.x()), std::abs(ridge.apex.y()), 0.5);
    EXPECT_NEAR(ridge.radius, 3.0, 0.3);
    const auto disc = section.disc_under(ridge, 14.0);
    ASSERT_TRUE(disc);
    EXPECT_NEAR(std::abs(disc->centre.x()), 3.5, 1e-6);
    EXPECT_NEAR(std::abs(disc->centre.y()), 3.5, 1e-6);
    EXPECT_NEAR(disc->touch_first.dot(disc->touch_second), 0.0, 1e-6);
  }
  EXPECT_TRUE(HandleSection(product::make_cylinder_product({.diameter = 35.0}).mesh, Vec3::Zero(),
                            Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY())
                  .ridges(16.0)
                  .empty());
}

TEST(HandleSection, SeatsADiscInTheNarrowSideOfAnEllipse) {
  // Semi-axes 18 and 12 mm: a disc of radius R < 12 that touches both flanks has its centre at
  // (e, 0) with e^2 = (a^2 - b^2)(1 - R^2 / b^2).
  geometry::TriangleMesh bar =
      geometry::make_cylinder({.radius = 1.0, .length = 100.0, .segments = 240, .rings = 4});
  for (Vec3& x : bar.vertices) x = Vec3(18.0 * x.x(), 12.0 * x.y(), x.z());
  const HandleSection section(bar, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY());
  const auto ridges = section.ridges(10.0);
  ASSERT_EQ(ridges.size(), 2U);
  for (const SectionRidge& ridge : ridges) {
    EXPECT_NEAR(std::abs(ridge.apex.x()), 18.0, 0.05);
    const auto disc = section.disc_under(ridge, 10.0);
    ASSERT_TRUE(disc);
    EXPECT_NEAR(std::abs(disc->centre.x()), std::sqrt(180.0 * (1.0 - 100.0 / 144.0)), 0.15);
  }
}

TEST(PlanReliefs, FindsTheRoundingThatTheImprintHasTheShapeOf) {
  // Along one edge, from z = -20 to 30, the imprint is what a rounding of 12 mm takes away.
  const auto depth = [](const Vec3& x) {
    const double off = (x.head<2>() - Eigen::Vector2d(5.5, 5.5)).norm();
    return x.x() > 5.5 && x.y() > 5.5 ? std::max(0.0, off - 12.0) : 0.0;
  };
  const Situation s = situation(
      prism(), [](const Vec3& x) { return x.x() + x.y() > 22.0 && x.z() > -20.0 && x.z() < 30.0; },
      depth);
  ReliefOptions options;
  options.largest_depth = 5.0;
  const ReliefPlan plan = plan_reliefs(s.map, s.region, s.region, s.imprint, options);
  ASSERT_EQ(plan.reliefs.size(), 1U);
  EXPECT_EQ(plan.notes.size(), 3U);  // the other edges aren't touched
  const RidgeRelief& relief = plan.reliefs[0];
  EXPECT_DOUBLE_EQ(relief.radius, 12.0);
  EXPECT_NEAR(relief.depth, 9.0 * kCorner, 0.03);
  EXPECT_NEAR(relief.half_angle, 0.25 * std::numbers::pi, 1e-4);
  EXPECT_NEAR(relief.start.x(), 5.5, 1e-4);
  EXPECT_NEAR(relief.start.y(), 5.5, 1e-4);
  EXPECT_NEAR(relief.start.z(), -23.0, 3.5);  // 3 mm margin, vertices 3 mm apart
  EXPECT_NEAR(relief.end.z(), 33.0, 3.5);
  EXPECT_NEAR(relief.outward.dot(Vec3(1, 1, 0).normalized()), 1.0, 1e-6);
  EXPECT_NEAR(relief.radius_before, 3.0, 0.4);
  EXPECT_FALSE(relief.is_open_start || relief.is_open_end);
}

TEST(PlanReliefs, KeepsToTheLargestDepthAndGoesThroughANearEnd) {
  const Situation s = situation(
      prism(), [](const Vec3& x) { return x.x() + x.y() > 22.0 && x.z() > 0.0; },
      [](const Vec3&) { return 8.0; });
  ReliefOptions options;
  options.largest_depth = 3.0;
  const ReliefPlan plan = plan_reliefs(s.map, s.region, s.region, s.imprint, options);
  ASSERT_EQ(plan.reliefs.size(), 1U);
  EXPECT_DOUBLE_EQ(plan.reliefs[0].radius, 10.0);  // (10 - 3) 0.414 = 2.9; 10.5 mm take 3.1
  EXPECT_TRUE(plan.reliefs[0].is_open_end);
  EXPECT_FALSE(plan.reliefs[0].is_open_start);
}

TEST(RidgeRelief, RunsOutAlongAnArcAndProjectsPointsOntoItself) {
  RidgeRelief relief;
  relief.start = Vec3(0, 0, -20);
  relief.end = Vec3(0, 0, 20);
  relief.outward = Vec3::UnitX();
  relief.radius = 10.0;
  relief.half_angle = 0.25 * std::numbers::pi;
  relief.run_out = 40.0;
  EXPECT_TRUE(is_cut(relief, Vec3(10.1, 0, 0)));
  EXPECT_FALSE(is_cut(relief, Vec3(9.9, 0, 0)));
  EXPECT_FALSE(is_cut(relief, Vec3(0, 11, 0)));  // beside the flanks
  // 15 mm beyond the end the cutter has risen by 40 - sqrt(40^2 - 15^2) = 2.92 mm.
  EXPECT_FALSE(is_cut(relief, Vec3(12.9, 0, 35)));
  EXPECT_TRUE(is_cut(relief, Vec3(12.95, 0, 35)));
  for (const Vec3& x : {Vec3(12, 3, 0), Vec3(14, 2, 33), Vec3(13, -4, -29)}) {
    ASSERT_TRUE(is_cut(relief, x));
    const Vec3 on = onto_relief(relief, x);
    // On the border: a little outwards is cut, a little inwards isn't.
    EXPECT_TRUE(is_cut(relief, on + 1e-4 * Vec3::UnitX()));
    EXPECT_FALSE(is_cut(relief, on - 1e-4 * Vec3::UnitX()));
  }
  relief.is_open_end = true;
  EXPECT_TRUE(is_cut(relief, Vec3(10.1, 0, 500)));
}

TEST(RelievedMesh, LosesTheVolumeBetweenTwoRoundings) {
  // All along one edge from r 3 to r 12: (1 - pi / 4)(12^2 - 3^2) mm^2 of the section.
  RidgeRelief relief;
  relief.start = Vec3(5.5, 5.5, -30);
  relief.end = Vec3(5.5, 5.5, 30);
  relief.outward = Vec3(1, 1, 0).normalized();
  relief.radius = 12.0;
  relief.half_angle = 0.25 * std::numbers::pi;
  relief.run_out = 40.0;
  relief.is_open_start = relief.is_open_end = true;
  const product::Product product = prism();
  const geometry::TriangleMesh after = relieved_mesh(product.mesh, std::vector{relief});
  const double removed = (1.0 - 0.25 * std::numbers::pi) * 135.0 * 130.0;
  EXPECT_NEAR(geometry::signed_volume(product.mesh) - geometry::signed_volume(after), removed,
              0.01 * removed);
}

TEST(PlanReliefs, RefusesByNameWhatHasNoRidge) {
  const Situation s = situation(
      product::make_cylinder_product({.diameter = 35.0}),
      [](const Vec3& x) { return std::abs(x.z()) < 30; }, [](const Vec3&) { return 2.0; });
  EXPECT_THAT([&] { plan_reliefs(s.map, s.region, s.region, s.imprint); },
              ::testing::ThrowsMessage<UsageError>(::testing::AllOf(
                  ::testing::HasSubstr("has no ridge that is narrower than a disc"),
                  ::testing::HasSubstr("there is nothing to round"))));
  Situation empty = s;
  empty.region.patches.clear();
  empty.region.title = "half of 10 hands";
  EXPECT_THAT([&] { plan_reliefs(empty.map, empty.region, empty.region, empty.imprint); },
              ::testing::ThrowsMessage<UsageError>(
                  "relief: the region \"half of 10 hands\" is empty; a smaller share of the hands "
                  "has one"));
}

}  // namespace
}  // namespace palmar::redesign
