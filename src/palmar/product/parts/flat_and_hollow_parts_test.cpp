// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "palmar/geometry/rigid3.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/product/parts/sdf_mesh_for_test.h"

namespace palmar::product {
namespace {

ProductParts parts_of(const Sdf& solid, const Box3& box, double spacing) {
  Product product;
  product.mesh = mesh_of(solid, box, spacing);
  return find_parts(product);
}

std::string kinds_of(const ProductParts& found) {
  std::string kinds;
  for (const ProductPart& part : found.parts) kinds += name_of(part.kind) + " ";
  return kinds;
}

// The solid turned by a rotation about 0.
Sdf turned(const Sdf& solid, const Quat& rotation) {
  return [solid, back = rotation.conjugate()](const Vec3& p) { return solid(back * p); };
}

// A bail of wire 10 mm thick in the plane of x and z, from z = low up to 180 mm, 140 mm wide from
// middle to middle, with a grip 20 mm thick over the middle 70 mm.
Sdf bail(double low) {
  const Sdf wire =
      sdf_tube({Vec3(-70, 0, low), Vec3(-70, 0, 180), Vec3(70, 0, 180), Vec3(70, 0, low)}, 5.0);
  return sdf_union(wire, sdf_tube({Vec3(-25, 0, 180), Vec3(25, 0, 180)}, 10.0));
}

TEST(FlatParts, ADishIsOnePlate) {
  // 220 mm wide, 6 mm thick, its rim rises by 12 mm.
  const Sdf dish = [](const Vec3& p) {
    const double r = std::hypot(p.x(), p.y());
    const double low = 0.3 * std::max(0.0, r - 70.0);
    return std::max({r - 110.0, low - p.z(), p.z() - low - 6.0});
  };
  const ProductParts found = parts_of(dish, Box3(Vec3(-111, -111, -1), Vec3(111, 111, 19)), 3.0);
  ASSERT_EQ(found.parts.size(), 1U) << kinds_of(found);
  const ProductPart& plate = found.parts[0];
  EXPECT_EQ(plate.kind, PartKind::kPlate);
  EXPECT_NEAR(plate.length, 220.0, 2.0);  // mm; the lattice rounds the edge
  ASSERT_TRUE(plate.face_normal);
  EXPECT_NEAR(std::abs(plate.face_normal->z()), 1.0, 1e-3);
}

TEST(FlatParts, AKnobOnABoardIsAPartOfItsOwn) {
  // A ball of 32 mm on a neck of 16 mm, its middle 24 mm above the board, off the board's middle.
  const Sdf board = sdf_box(Vec3(0, 0, -8), Vec3(150, 100, 16));
  const Sdf knob = sdf_union(sdf_tube({Vec3(20, 5, -4), Vec3(20, 5, 20)}, 8.0),
                             sdf_tube({Vec3(20, 5, 24), Vec3(20, 5, 24.1)}, 16.0));
  Product product;
  product.mesh = mesh_of(sdf_union(board, knob), Box3(Vec3(-76, -51, -17), Vec3(76, 51, 41)), 2.0);
  const ProductParts found = find_parts(product);
  ASSERT_GE(found.parts.size(), 2U) << kinds_of(found);  // the neck may be a part of its own
  EXPECT_EQ(found.parts[0].kind, PartKind::kPlate);
  EXPECT_NEAR(found.parts[0].length, 150.0, 1.0);  // mm
  EXPECT_NEAR(found.parts[0].thickness, 16.0, 3.0);
  EXPECT_NE(found.parts[1].kind, PartKind::kPlate);
  for (int t = 0; t < product.mesh.triangle_count(); ++t) {
    double z = 0.0;
    for (const int i : product.mesh.triangles[t]) z += product.mesh.vertices[i].z() / 3.0;
    // The ball is the knob's alone.
    if (z > 16.0 || z < 0.0) {
      EXPECT_EQ(found.part_of_triangle[t] == 1, z > 0.0) << z;
    }
  }
}

TEST(BodyAxis, RunsBetweenTheFacesOfABoxHoweverItIsTurnedOrMeshed) {
  const Quat turn(Eigen::AngleAxisd(std::numbers::pi / 6.0, Vec3(1, 2, 3).normalized()));
  const Box3 box(Vec3::Constant(-60), Vec3::Constant(60));
  for (const double spacing : {2.0, 3.1}) {
    const ProductParts cube =
        parts_of(turned(sdf_box({0, 0, 0}, {60, 60, 60}), turn), box, spacing);
    ASSERT_EQ(cube.parts.size(), 1U) << kinds_of(cube);
    EXPECT_EQ(cube.parts[0].kind, PartKind::kBody);
    EXPECT_NEAR(cube.parts[0].length, 60.0, 1.5);  // mm; the lattice rounds edges
    EXPECT_NEAR(cube.parts[0].width, 60.0, 1.5);
    EXPECT_NEAR(cube.parts[0].girth, 240.0, 5.0);
    const Vec3 axis = turn.conjugate() * cube.parts[0].line.front().axis;
    EXPECT_GT(axis.cwiseAbs().maxCoeff(), std::cos(0.02));  // rad: 1 degree

    const ProductParts block =
        parts_of(turned(sdf_box({0, 0, 0}, {70, 80, 55}), turn), box, spacing);
    ASSERT_EQ(block.parts.size(), 1U) << kinds_of(block);
    EXPECT_NEAR(block.parts[0].length, 80.0, 1.5);
    EXPECT_NEAR(block.parts[0].width, 70.0, 1.5);
  }
}

TEST(BodyAxis, OfADrumIsTheOneThatItIsRoundAbout) {
  const ProductParts drum =
      parts_of(sdf_cone(70.0, 45.0, 45.0), Box3(Vec3(-46, -46, -1), Vec3(46, 46, 71)), 2.5);
  ASSERT_EQ(drum.parts.size(), 1U) << kinds_of(drum);
  EXPECT_NEAR(std::abs(drum.parts[0].line.front().axis.z()), 1.0, 1e-3);
  EXPECT_NEAR(drum.parts[0].length, 70.0, 1.0);
}

// A body with a bail whose grip is thicker than the wire.
void expect_body_and_bail(const ProductParts& found, double body_height) {
  ASSERT_EQ(found.parts.size(), 2U) << kinds_of(found);
  EXPECT_EQ(found.parts[0].kind, PartKind::kBody);
  const ProductPart& loop = found.parts[1];
  ASSERT_EQ(loop.kind, PartKind::kLoop) << kinds_of(found);
  EXPECT_EQ(loop.ends[0].joined, 1);
  EXPECT_EQ(loop.ends[1].joined, 1);
  ASSERT_TRUE(loop.opening);
  EXPECT_NEAR(std::abs(loop.opening->axis.y()), 1.0, 0.01);
  // From the body to the grip.
  EXPECT_NEAR(loop.opening->disc, 170.0 - body_height, 2.0);  // mm
  double thickest = 0.0;
  for (const PartSection& s : loop.sections) thickest = std::max(thickest, s.girth);
  EXPECT_NEAR(thickest, 20.0 * std::numbers::pi,
              0.08 * 20.0 * std::numbers::pi);  // the grip's, on the lattice
}

TEST(Bails, ABoxWithABailIsABodyAndALoop) {
  const Sdf box = sdf_box(Vec3(0, 0, 50), Vec3(170, 80, 100));
  expect_body_and_bail(
      parts_of(sdf_union(box, bail(95.0)), Box3(Vec3(-86, -41, -1), Vec3(86, 41, 191)), 2.5),
      100.0);
}

TEST(Bails, AnOpenBucketIsABodyWithALoop) {
  // 150 mm wide and 110 mm high, walls of 5 mm; open at the top.
  const Sdf wall = sdf_without(sdf_cone(110.0, 60.0, 75.0), [](const Vec3& p) {
    return std::max(std::hypot(p.x(), p.y()) - (55.0 + 15.0 * p.z() / 110.0), 5.0 - p.z());
  });
  const ProductParts found =
      parts_of(sdf_union(wall, bail(100.0)), Box3(Vec3(-76, -76, -1), Vec3(76, 76, 191)), 2.5);
  ASSERT_EQ(found.parts.size(), 2U) << kinds_of(found);
  EXPECT_EQ(found.parts[0].kind, PartKind::kBody);
  EXPECT_NEAR(std::abs(found.parts[0].line.front().axis.z()), 1.0, 0.02);
  EXPECT_EQ(found.parts[1].kind, PartKind::kLoop);
}

}  // namespace
}  // namespace palmar::product
