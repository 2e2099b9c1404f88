// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/separate_sheets.h"

#include <gtest/gtest.h>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/low_triangles.h"
#include "palmar/geometry/repair/weld.h"

namespace palmar::geometry {
namespace {

/// Two cubes of edge 10, the second shifted, with common corners welded.
TriangleMesh two_cubes(const Vec3& shift) {
  TriangleMesh cubes = make_box(Vec3(10, 10, 10));
  const TriangleMesh cube = cubes;
  const int n = cube.vertex_count();
  for (const Vec3& x : cube.vertices) cubes.vertices.push_back(x + shift);
  for (const Triangle& t : cube.triangles) {
    cubes.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  return weld(cubes, {.tolerance = 1e-9, .drops_duplicates = false}).mesh;
}

TEST(SeparateTouchingSheets, CubesThatTouchInAnEdgeBecomeTwo) {
  const TriangleMesh cubes = two_cubes(Vec3(10, 10, 0));
  ASSERT_EQ(examine_topology(cubes).non_manifold_edges, 1);
  const SeparatedSheets separated = separate_touching_sheets(cubes, 1e-3);
  EXPECT_EQ(separated.doubled.size(), 2u);
  EXPECT_EQ(separated.separated_edges.size(), 1u);
  EXPECT_TRUE(separated.left_edges.empty());
  const TopologyReport report = examine_topology(weld(separated.mesh, {.tolerance = 5e-4}).mesh);
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.euler_number, 4);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_NEAR(signed_volume(separated.mesh), 2000.0, 0.5);
  EXPECT_LT(signed_volume(separated.mesh), 2000.0);  // each copy lies inside of its own solid
}

TEST(SeparateTouchingSheets, CubesThatTouchInACornerBecomeTwo) {
  const SeparatedSheets separated = separate_touching_sheets(two_cubes(Vec3(10, 10, 10)), 1e-3);
  EXPECT_EQ(separated.doubled.size(), 1u);
  const TopologyReport report = examine_topology(separated.mesh);
  EXPECT_EQ(report.components, 2);
  EXPECT_TRUE(report.is_two_manifold);
}

TEST(SeparateTouchingSheets, AWallBetweenCubesStays) {
  // Their common face stands there once: three triangles at each of its edges.
  TriangleMesh cubes = two_cubes(Vec3(10, 0, 0));
  cubes = weld(cubes, {.tolerance = 1e-9}).mesh;
  const SeparatedSheets separated = separate_touching_sheets(cubes, 1e-3);
  EXPECT_TRUE(separated.doubled.empty());
  EXPECT_EQ(separated.left_edges.size(), 4u);
  EXPECT_EQ(separated.mesh.triangles, cubes.triangles);
}

TEST(SeparateTouchingSheets, AManifoldMeshStays) {
  const TriangleMesh torus = make_torus(20, 5, 24, 12);
  const SeparatedSheets separated = separate_touching_sheets(torus, 1e-3);
  EXPECT_EQ(separated.mesh.triangles, torus.triangles);
  EXPECT_EQ(separated.mesh.vertices, torus.vertices);
}

TEST(LowTriangles, ACornerInTheMiddleOfAnEdgeIsTakenIn) {
  // The square 0 1 2 3; corner 4 lies on its diagonal, in a triangle without area.
  const TriangleMesh square{
      {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 2, 0), Vec3(1, 1, 0)},
      {{0, 1, 2}, {0, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  const LowTrianglesResult repaired = repair_low_triangles(square, 1e-6);
  EXPECT_EQ(repaired.places.size(), 1u);
  EXPECT_TRUE(repaired.left.empty());
  EXPECT_DOUBLE_EQ(surface_area(repaired.mesh), 4.0);
  EXPECT_EQ(repaired.mesh.triangle_count(), 4);
  const TopologyReport report = examine_topology(repaired.mesh);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_TRUE(report.is_oriented);
  for (const Triangle& t : repaired.mesh.triangles) {
    EXPECT_GT(triangle_normals(repaired.mesh.vertices, std::vector<Triangle>{t})[0].z(), 0.9);
  }
}

TEST(LowTriangles, AFreeOneIsDropped) {
  const TriangleMesh strip{{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 0)},
                           {{0, 3, 2}, {3, 1, 2}, {0, 1, 3}}};
  const LowTrianglesResult repaired = repair_low_triangles(strip, 1e-6);
  EXPECT_EQ(repaired.mesh.triangle_count(), 2);
  EXPECT_DOUBLE_EQ(surface_area(repaired.mesh), 1.0);
}

TEST(LowTriangles, LeastHeightIsTwiceTheAreaOverTheLongestEdge) {
  EXPECT_DOUBLE_EQ(least_height(Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 3, 0)), 12.0 / 5.0);
  EXPECT_DOUBLE_EQ(least_height(Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)), 0.0);
}

}  // namespace
}  // namespace palmar::geometry
