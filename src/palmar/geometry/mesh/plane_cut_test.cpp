// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/plane_cut.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

double rim_length(const CutMesh& cut) {
  double sum = 0.0;
  for (const std::vector<int>& loop : cut.rim) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int a = loop[k];
      const int b = loop[(k + 1) % loop.size()];
      sum += (cut.mesh.vertices[b] - cut.mesh.vertices[a]).norm();
    }
  }
  return sum;
}

double area(const CutMesh& cut) {
  double sum = 0.0;
  for (const Triangle& t : cut.mesh.triangles) {
    const auto at = [&](std::size_t k) { return cut.mesh.vertices[t[k]]; };
    sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return sum;
}

TEST(CutByPlane, CapOfASphereHasItsAreaAndRim) {
  // Above height h the cap of a sphere has area 2 pi R (R - h), its rim radius sqrt(R^2 - h^2).
  const CutMesh cut = cut_by_plane(make_icosphere(10.0, 5), Vec3(0.0, 0.0, 4.03), Vec3::UnitZ());
  ASSERT_EQ(cut.rim.size(), 1u);
  EXPECT_NEAR(area(cut), 2.0 * std::numbers::pi * 10.0 * 5.97, 0.5);  // mm^2, flat triangles
  EXPECT_NEAR(rim_length(cut), 2.0 * std::numbers::pi * std::sqrt(100.0 - 4.03 * 4.03), 0.1);
  for (const Vec3& v : cut.mesh.vertices) EXPECT_GE(v.z(), 4.03 - 1e-12);
  EXPECT_EQ(cut.triangle_of.size(), cut.mesh.triangles.size());
}

TEST(CutByPlane, BothHalvesTogetherAreTheWholeSurface) {
  const TriangleMesh ball = make_icosphere(10.0, 3);
  const Vec3 normal = Vec3(1.0, 2.0, -2.0) / 3.0;
  const Vec3 point(0.3, 0.2, 1.0);
  const CutMesh one = cut_by_plane(ball, point, normal);
  const CutMesh other = cut_by_plane(ball, point, -normal);
  const CutMesh whole = cut_by_plane(ball, 100.0 * normal, -normal);
  EXPECT_NEAR(area(one) + area(other), area(whole), 1e-9);
  EXPECT_NEAR(rim_length(one), rim_length(other), 1e-9);
}

TEST(CutByPlane, RimRunsLikeItsTriangles) {
  // Outward triangles above the plane run clockwise round the cut, seen against its normal.
  const CutMesh cut = cut_by_plane(make_icosphere(10.0, 3), Vec3(0.0, 0.0, 1.0), Vec3::UnitZ());
  ASSERT_EQ(cut.rim.size(), 1u);
  Vec3 twice_area = Vec3::Zero();
  const std::vector<int>& loop = cut.rim.front();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    twice_area += cut.mesh.vertices[loop[k]].cross(cut.mesh.vertices[loop[(k + 1) % loop.size()]]);
  }
  EXPECT_GT(twice_area.z(), 0.0);
}

TEST(CutByPlane, MeshOnOneSideIsWholeOrEmpty) {
  const TriangleMesh ball = make_icosphere(10.0, 2);
  const CutMesh all = cut_by_plane(ball, Vec3(0.0, 0.0, -11.0), Vec3::UnitZ());
  EXPECT_EQ(all.mesh.triangle_count(), ball.triangle_count());
  EXPECT_TRUE(all.rim.empty());
  EXPECT_TRUE(cut_by_plane(ball, Vec3(0.0, 0.0, 11.0), Vec3::UnitZ()).mesh.triangles.empty());
}

TEST(CutByPlane, SnapLeavesNoEdgeShorterThanItself) {
  const double snap = 0.2;
  const CutMesh cut =
      cut_by_plane(make_icosphere(10.0, 4), Vec3(0.0, 0.0, 2.57), Vec3::UnitZ(), snap);
  for (const Vec3& v : cut.mesh.vertices) {
    EXPECT_TRUE(std::abs(v.z() - 2.57) < 1e-9 || v.z() > 2.57 + snap);
  }
}

TEST(CutByPlane, SaysWhatIsWrongWithThePlane) {
  const TriangleMesh ball = make_icosphere(10.0, 1);
  EXPECT_THAT([&] { cut_by_plane(ball, Vec3::Zero(), Vec3(0.0, 0.0, 2.0)); },
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("a unit vector is required")));
  EXPECT_THAT([&] { cut_by_plane(ball, Vec3::Zero(), Vec3::UnitZ(), -1.0); },
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("0 or more is required")));
}

}  // namespace
}  // namespace palmar::geometry
