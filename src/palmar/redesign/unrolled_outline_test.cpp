// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/unrolled_outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/product/primitives.h"

namespace palmar::redesign {
namespace {

ContactRegion region_of(const std::vector<std::vector<Vec3>>& outlines) {
  ContactRegion region;
  region.title = "palm";
  region.patches.resize(1);
  for (const auto& points : outlines) region.patches[0].outline.push_back({points, 0.0});
  return region;
}

double length_of(const UnrolledLine& line) {
  double sum = 0.0;
  for (std::size_t i = 0; i + (line.is_closed ? 0 : 1) < line.points.size(); ++i) {
    sum += (line.points[(i + 1) % line.points.size()] - line.points[i]).norm();
  }
  return sum;
}

TEST(Unroll, ACircleRoundACylinderBecomesAStraightLineOfItsCircumference) {
  std::vector<Vec3> circle;
  for (int i = 0; i < 360; ++i) {
    const double a = i * std::numbers::pi / 180.0;
    circle.emplace_back(20.0 * std::cos(a), 20.0 * std::sin(a), 7.0);
  }
  // A region of no height can't determine where it lies: a second circle.
  std::vector<Vec3> other = circle;
  for (Vec3& x : other) x.z() = -12.0;
  const UnrolledOutline sheet =
      unroll(product::make_cylinder_product({.diameter = 40.0, .length = 100.0}).mesh,
             {region_of({circle, other})});
  // Chords of 0.01 mm sagitta are 0.02 % short.
  EXPECT_NEAR(sheet.width, std::numbers::pi * 40.0, 5e-4 * std::numbers::pi * 40.0);
  ASSERT_EQ(sheet.lines.size(), 2U);
  for (const UnrolledLine& line : sheet.lines) {
    EXPECT_FALSE(line.is_closed);
    EXPECT_NEAR(length_of(line), std::numbers::pi * 40.0, 5e-4 * std::numbers::pi * 40.0);
    for (const Eigen::Vector2d& p : line.points) {
      EXPECT_NEAR(p.y(), line.points.front().y(), 1e-9);
      EXPECT_GE(p.x(), -1e-9);
      EXPECT_LE(p.x(), sheet.width + 1e-9);
    }
  }
  EXPECT_TRUE(sheet.edges.empty());
  EXPECT_NEAR(sheet.high - sheet.low, 100.0, 1e-9);
}

TEST(Unroll, KeepsLengthsOverTheFilletsOfAPrism) {
  // Round one filleted edge of a 35 mm prism: 10 mm of flat, a quarter of r 3 mm, 10 mm of flat; up
  // 40 mm and back.
  std::vector<Vec3> up, loop;
  for (int i = 0; i <= 20; ++i) up.emplace_back(17.5, 4.5 + 0.5 * i, 0.0);
  for (int i = 1; i <= 30; ++i) {
    const double a = 0.5 * std::numbers::pi * i / 30;
    up.emplace_back(14.5 + 3.0 * std::cos(a), 14.5 + 3.0 * std::sin(a), 0.0);
  }
  for (int i = 1; i <= 20; ++i) up.emplace_back(14.5 - 0.5 * i, 17.5, 0.0);
  for (const Vec3& x : up) loop.emplace_back(x - Vec3(0, 0, 20));
  for (auto x = up.rbegin(); x != up.rend(); ++x) loop.emplace_back(*x + Vec3(0, 0, 20));
  const UnrolledOutline sheet =
      unroll(product::make_prism_product(
                 {.width = 35.0, .depth = 35.0, .length = 130.0, .fillet_radius = 3.0})
                 .mesh,
             {region_of({loop})});
  const double across = 20.0 + 1.5 * std::numbers::pi;
  ASSERT_EQ(sheet.lines.size(), 1U);
  EXPECT_TRUE(sheet.lines[0].is_closed);  // the cut is on the other side
  EXPECT_NEAR(length_of(sheet.lines[0]), 2.0 * (across + 40.0), 0.02);
  EXPECT_NEAR(sheet.width, 4.0 * 29.0 + 6.0 * std::numbers::pi, 0.02);
  ASSERT_EQ(sheet.edges.size(), 8U);  // both ends of four flat sides
  // Seen from outside with the axis upwards nothing is mirrored: y of the product's +x face grows
  // to the right there.
  const auto& p = sheet.lines[0].points;
  EXPECT_GT(p[10].x(), p[0].x());
}

TEST(Unroll, RefusesWhatIsNoCylinderOrPrism) {
  std::vector<Vec3> belt;
  for (int i = 0; i < 40; ++i) {
    const double a = i * std::numbers::pi / 20.0, z = i % 2 == 0 ? 8.0 : -2.0;
    const double r = std::sqrt(900.0 - z * z);
    belt.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  EXPECT_THAT(
      [&] {
        unroll(product::make_sphere_product({.diameter = 60.0}).mesh, {region_of({belt})},
               Vec3::UnitZ());
      },
      ::testing::ThrowsMessage<UsageError>(::testing::AllOf(
          ::testing::HasSubstr("sections of the product differ by"),
          ::testing::HasSubstr("only a cylinder or a prism (up to 0.1 mm) can be unrolled"))));
  const geometry::TriangleMesh bar =
      product::make_cylinder_product({.diameter = 40.0, .length = 100.0}).mesh;
  EXPECT_THAT([&] { unroll(bar, {ContactRegion()}); },
              ::testing::ThrowsMessage<UsageError>("unrolled outline: the region is empty"));
  // Over the end face.
  const std::vector<Vec3> end = {{20, 0, 40}, {20, 1, 50}, {10, 0, 50}, {5, 5, 50}};
  EXPECT_THAT([&] { unroll(bar, {region_of({end})}); },
              ::testing::ThrowsMessage<UsageError>(
                  ::testing::HasSubstr("leaves the side of the product at (10.0, 0.0, 50.0) mm")));
}

}  // namespace
}  // namespace palmar::redesign
