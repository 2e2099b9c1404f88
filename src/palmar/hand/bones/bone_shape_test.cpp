// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/bones/bone_shape.h"

#include <gtest/gtest.h>

#include <numbers>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/section.h"

namespace palmar::hand {
namespace {

BoneShape phalanx() {
  return {.from = {1.0, 2.0, 3.0},
          .to = {1.0, 42.0, 3.0},
          .palmar = Vec3::UnitZ(),
          .station = {{0.06, 7.0, 5.5}, {0.55, 4.5, 4.0}, {0.9, 5.5, 4.5}},
          .base_cap = 2.0,
          .head_cap = 4.5,
          .groove = 0.8};
}

TEST(BoneMesh, IsClosedManifoldAndOutward) {
  const geometry::TriangleMesh mesh = bone_mesh(phalanx());
  const geometry::TopologyReport report = geometry::examine_topology(mesh);
  EXPECT_TRUE(report.is_closed);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_TRUE(report.is_oriented);
  EXPECT_EQ(report.euler_number, 2);
  EXPECT_GT(geometry::signed_volume(mesh), 0.0);
}

TEST(BoneMesh, FillsTheLengthAndTheWidthsAskedFor) {
  const geometry::TriangleMesh mesh = bone_mesh(phalanx());
  EXPECT_LE(geometry::extent(mesh.vertices, Vec3::UnitY()), 40.0);               // mm
  EXPECT_GE(geometry::extent(mesh.vertices, Vec3::UnitY()), 40.0 - 0.8 - 1e-9);  // the groove
  EXPECT_NEAR(geometry::extent(mesh.vertices, Vec3::UnitX()), 14.0, 0.3);        // base
  const auto shaft = geometry::plane_section(mesh, {1.0, 24.0, 3.0}, Vec3::UnitY());
  ASSERT_EQ(shaft.size(), 1u);
  EXPECT_NEAR(geometry::extent(shaft[0].point, Vec3::UnitX()), 9.0, 0.2);
}

TEST(BoneMesh, HasTwoCondylesWithAGrooveBetween) {
  const geometry::TriangleMesh mesh = bone_mesh(phalanx());
  // Highest point along the axis, in the middle and at the sides.
  double middle = 0.0, side = 0.0;
  for (const Vec3& v : mesh.vertices) {
    const double aside = std::abs(v.x() - 1.0);
    if (aside < 0.5) middle = std::max(middle, v.y());
    if (aside > 2.0) side = std::max(side, v.y());
  }
  EXPECT_LT(middle, 42.0 - 0.6);
  EXPECT_LT(side, 42.0);
  // The palmar side is hollow where the dorsal side is round.
  const auto head = geometry::plane_section(mesh, {1.0, 38.0, 3.0}, Vec3::UnitY());
  ASSERT_EQ(head.size(), 1u);
  double palmar_middle = 0.0, dorsal_middle = 0.0;
  for (const Vec3& p : head[0].point) {
    if (std::abs(p.x() - 1.0) > 0.8) continue;
    palmar_middle = std::max(palmar_middle, p.z() - 3.0);
    dorsal_middle = std::max(dorsal_middle, 3.0 - p.z());
  }
  EXPECT_LT(palmar_middle, dorsal_middle - 0.4);
}

TEST(BoneMesh, MirrorsWithItsAxis) {
  BoneShape mirrored = phalanx();
  mirrored.from.x() = mirrored.to.x() = -1.0;
  const geometry::TriangleMesh right = bone_mesh(phalanx());
  const geometry::TriangleMesh left = bone_mesh(mirrored);
  EXPECT_NEAR(geometry::signed_volume(left), geometry::signed_volume(right),
              1e-9 * geometry::signed_volume(right));
}

TEST(EllipsoidMesh, HasTheVolumeOfAnEllipsoidFromBelow) {
  const Vec3 half(5.0, 7.0, 6.0);
  const geometry::TriangleMesh mesh =
      ellipsoid_mesh({1.0, 2.0, 3.0}, Eigen::Matrix3d::Identity(), half, 40, 60);
  const double exact = 4.0 / 3.0 * std::numbers::pi * half.prod();
  EXPECT_LT(geometry::signed_volume(mesh), exact);  // corners lie on the ellipsoid
  EXPECT_NEAR(geometry::signed_volume(mesh), exact, 0.01 * exact);
  EXPECT_TRUE(geometry::examine_topology(mesh).is_two_manifold);
  EXPECT_TRUE(geometry::examine_topology(mesh).is_closed);
}

}  // namespace
}  // namespace palmar::hand
