// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/silhouette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

SheetGrid square_grid(double half, double cell) {
  SheetGrid grid;
  grid.cell = cell;
  grid.width = grid.height = static_cast<int>(2.0 * half / cell);
  grid.corner = 0.5 * cell * Eigen::Vector2d(1 - grid.width, grid.height - 1);
  return grid;
}

TEST(Silhouette, OfABallIsTheEllipseThatTheConeRoundItCuts) {
  // From straight above at height h the cone touches a ball of radius r with its centre at height z
  // under the angle asin(r / (h - z)): on the sheet a circle of radius h tan of it.
  geometry::TriangleMesh ball = geometry::make_icosphere(20.0, 5);
  for (Vec3& v : ball.vertices) v += Vec3(3.0, -4.0, 30.0);
  const Vec3 eye(3.0, -4.0, 400.0);
  const SheetGrid grid = square_grid(40.0, 0.25);
  const imaging::VoxelMask mask = silhouette(ball, eye, grid);
  const double radius = 400.0 * std::tan(std::asin(20.0 / 370.0));
  const double area = 0.25 * 0.25 * std::accumulate(mask.begin(), mask.end(), 0.0);
  EXPECT_NEAR(area, std::numbers::pi * radius * radius, 4.0);  // mm2; facets and cells
  const auto is_in = [&](double x, double y) {
    const Eigen::Vector2d at = grid.place({x, y});
    return mask[grid.at(static_cast<int>(std::lround(at.x())),
                        static_cast<int>(std::lround(at.y())))] != 0;
  };
  EXPECT_TRUE(is_in(3.0 + radius - 0.4, -4.0));
  EXPECT_FALSE(is_in(3.0 + radius + 0.4, -4.0));
  EXPECT_TRUE(is_in(3.0, -4.0 - radius + 0.4));
  EXPECT_FALSE(is_in(3.0, -4.0 - radius - 0.4));
}

TEST(Silhouette, HeightMovesItAwayFromTheCamerasFoot) {
  // A small plate at height 100 under a camera at 400 right above the origin: from x = 30 to 40.
  const geometry::TriangleMesh plate{{{30, -5, 100}, {33, -5, 100}, {33, 5, 100}, {30, 5, 100}},
                                     {{0, 1, 2}, {0, 2, 3}}};
  const SheetGrid grid = square_grid(50.0, 0.5);
  const imaging::VoxelMask mask = silhouette(plate, {0, 0, 400}, grid);
  const auto count = std::accumulate(mask.begin(), mask.end(), 0.0);
  EXPECT_NEAR(0.25 * count, 4.0 * (40.0 / 3.0), 2.0);  // 40/3 times larger each way: 4 x 13.3 mm
  const Eigen::Vector2d at = grid.place({42.0, 0.0});
  EXPECT_EQ(mask[grid.at(static_cast<int>(at.x() + 0.5), static_cast<int>(at.y() + 0.5))], 1);
}

}  // namespace
}  // namespace palmar::capture
