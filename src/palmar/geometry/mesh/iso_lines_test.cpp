// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/iso_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

std::vector<double> field_of(const TriangleMesh& mesh, double (*f)(const Vec3&)) {
  std::vector<double> field;
  for (const Vec3& x : mesh.vertices) field.push_back(f(x));
  return field;
}

double length_of(const IsoLoop& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    sum += (loop.points[(i + 1) % loop.points.size()] - loop.points[i]).norm();
  }
  return sum;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(IsoLoops, GoRoundASphereAtAHeightWithTheInsideOnTheLeft) {
  const TriangleMesh ball = make_icosphere(20.0, 5);
  const auto height = field_of(ball, [](const Vec3& x) { return x.z(); });
  const auto loops = iso_loops(ball, height, 12.0);
  ASSERT_EQ(loops.size(), 1U);
  // Radius 16 mm; a polygon of some 100 corners is 0.1 % short.
  EXPECT_NEAR(length_of(loops[0]), 2.0 * std::numbers::pi * 16.0, 0.2);
  double turn = 0.0;  // seen from outside (above): counter-clockwise, the cap is on the left
  for (std::size_t i = 0; i < loops[0].points.size(); ++i) {
    const Vec3 &a = loops[0].points[i], &b = loops[0].points[(i + 1) % loops[0].points.size()];
    EXPECT_NEAR(a.z(), 12.0, 1e-9);
    turn += a.cross(b).z();
  }
  EXPECT_GT(turn, 0.0);
  EXPECT_GE(ball.vertices[loops[0].inside_vertex].z(), 12.0);
  // A cap of height h has the area 2 pi r h.
  EXPECT_NEAR(sum_of(areas_above(ball, height, 12.0)), 2.0 * std::numbers::pi * 20.0 * 8.0, 3.0);
}

TEST(IsoLoops, TwoSidesShareTheArea) {
  const TriangleMesh ball = make_icosphere(20.0, 3);
  auto field = field_of(ball, [](const Vec3& x) { return x.x() * x.y() + 0.3 * x.z(); });
  const double above = sum_of(areas_above(ball, field, 1.0));
  for (double& f : field) f = -f;
  const double below = sum_of(areas_above(ball, field, -1.0));
  EXPECT_NEAR(above + below, surface_area(ball), 1e-6);
}

TEST(IsoLoops, EndAtABorderAsIfItWereOutside) {
  const TriangleMesh sheet = make_grid_patch(10, 10, 1.0);
  const std::vector<double> field(sheet.vertices.size(), 1.0);
  const auto loops = iso_loops(sheet, field, 0.5);
  ASSERT_EQ(loops.size(), 1U);  // half way between the border and the next row
  EXPECT_LT(length_of(loops[0]), 40.0);
  EXPECT_GT(length_of(loops[0]), 32.0);
}

TEST(IsoParts, AreWhatHangsTogetherWithItsArea) {
  const TriangleMesh ball = make_icosphere(20.0, 4);
  const auto field = field_of(ball, [](const Vec3& x) { return std::abs(x.z()); });
  const IsoParts parts = iso_parts(ball, field, 12.0);
  ASSERT_EQ(parts.area.size(), 3U);  // two caps and the belt between them
  EXPECT_EQ(std::count(parts.is_inside.begin(), parts.is_inside.end(), 1), 2);
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_NEAR(parts.area[p],
                2.0 * std::numbers::pi * 20.0 * (parts.is_inside[p] != 0 ? 8.0 : 24.0), 20.0);
  }
  EXPECT_NEAR(sum_of(parts.area), surface_area(ball), 1e-6);
}

TEST(IsoLoops, NothingAboveGivesNothing) {
  const TriangleMesh ball = make_icosphere(20.0, 2);
  const std::vector<double> field(ball.vertices.size(), 0.0);
  EXPECT_TRUE(iso_loops(ball, field, 1.0).empty());
  EXPECT_EQ(sum_of(areas_above(ball, field, 1.0)), 0.0);
  EXPECT_TRUE(iso_loops(TriangleMesh(), {}, 0.0).empty());
  EXPECT_THAT([&] { iso_loops(ball, std::vector<double>(3), 0.0); },
              testing::ThrowsMessage<UsageError>(
                  "level lines: the field has 3 values; one for each of the mesh's 162 vertices is "
                  "required"));
}

}  // namespace
}  // namespace palmar::geometry
