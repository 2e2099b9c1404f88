// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/subdivide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::geometry {
namespace {

const SubdivisionOptions kPlainLoop{
    .scheme = SubdivisionScheme::kLoop, .levels = 1, .projects_to_limit = false};

TEST(Subdivide, OnceGivesTheVerticesOfLoopsMasks) {
  // Octahedron of radius 1: n = 4, b = 3/32. Vertex: 1 - 4 b = 5/8 of itself (the neighbours
  // cancel). Edge: 3/8 (a + b) + 1/8 (c + d), where c and d cancel.
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const TriangleMesh result = subdivide(mesh, kPlainLoop);
  EXPECT_EQ(result.vertex_count(), 6 + 12);
  EXPECT_EQ(result.triangle_count(), 32);
  EXPECT_NEAR((result.vertices[0] - Vec3(0.625, 0, 0)).norm(), 0.0, 1e-15);
  for (size_t e = 6; e < result.vertices.size(); ++e) {
    EXPECT_NEAR(result.vertices[e].norm(), 0.375 * std::sqrt(2.0), 1e-15);
  }
}

TEST(Subdivide, LimitMaskIsWhereRepeatedRefinementGoes) {
  const TriangleMesh mesh = make_torus(5.0, 2.0, 5, 4);
  const TriangleMesh limit = subdivide(mesh, {.scheme = SubdivisionScheme::kLoop, .levels = 0});
  const TriangleMesh deep = subdivide(
      mesh, {.scheme = SubdivisionScheme::kLoop, .levels = 6, .projects_to_limit = false});
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    // A vertex nears its limit by a factor of about 1/4 per level.
    EXPECT_NEAR((limit.vertices[v] - deep.vertices[v]).norm(), 0.0, 3e-3);
  }
}

TEST(Subdivide, KeepsFlatThingsFlatAndStraightBordersStraight) {
  const TriangleMesh result =
      subdivide(make_grid_patch(4, 3, 1.0), {.scheme = SubdivisionScheme::kLoop, .levels = 2});
  for (const Vec3& v : result.vertices) {
    EXPECT_EQ(v.z(), 0.0);
    EXPECT_GE(v.x(), -1e-12);
    EXPECT_LE(v.x(), 4.0 + 1e-12);
  }
  const TopologyReport report = examine_topology(result);
  EXPECT_EQ(report.euler_number, 1);
  EXPECT_TRUE(report.is_two_manifold);
}

TEST(Subdivide, BorderBecomesACubicBSplineWhateverIsInside) {
  // Two patches with the same border and another inner vertex.
  TriangleMesh low = make_lattice_patch(1.0, 1.0), high = low;
  high.vertices[0].z() = 3.0;
  const SubdivisionOptions options{.scheme = SubdivisionScheme::kLoop, .levels = 3};
  const TriangleMesh a = subdivide(low, options), b = subdivide(high, options);
  for (const auto& [v, w] : boundary_edges(build_topology(a))) {
    EXPECT_EQ(a.vertices[v], b.vertices[v]);
    EXPECT_EQ(a.vertices[w], b.vertices[w]);
  }
  // Limit of a regular hexagon's corner: 2/3 + 2 * 1/6 * cos 60 deg = 5/6 of the radius.
  EXPECT_NEAR(a.vertices[1].norm(), 5.0 / 6.0, 1e-14);
}

TEST(Subdivide, KeepsTheTopologyOfATorus) {
  for (const auto scheme : {SubdivisionScheme::kLoop, SubdivisionScheme::kFittedLoop,
                            SubdivisionScheme::kLoopOfVolume}) {
    const TopologyReport report =
        examine_topology(subdivide(make_torus(5.0, 2.0, 6, 5), {.scheme = scheme, .levels = 2}));
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
    EXPECT_EQ(report.euler_number, 0);
    EXPECT_EQ(report.triangles, 16 * 60);
  }
}

TEST(Subdivide, FittedLoopMeetsTheGivenVerticesAfterManyRounds) {
  const TriangleMesh mesh = make_torus(5.0, 2.0, 8, 6);
  const TriangleMesh result =
      subdivide(mesh, {.scheme = SubdivisionScheme::kFittedLoop, .levels = 2, .fit_rounds = 300});
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_NEAR((result.vertices[v] - mesh.vertices[v]).norm(), 0.0, 1e-9);
  }
}

TEST(Subdivide, LoopOfVolumeKeepsTheVolumeThatLoopLoses) {
  const TriangleMesh mesh = make_torus(5.0, 2.0, 9, 6);
  const double volume = signed_volume(mesh);
  EXPECT_LT(signed_volume(subdivide(mesh, kPlainLoop)), 0.97 * volume);
  for (const int levels : {1, 2, 3}) {
    EXPECT_NEAR(signed_volume(subdivide(mesh, {.levels = levels})) / volume, 1.0, 2e-6);
  }
}

TEST(Subdivide, CommutesWithRigidMotion) {
  const TriangleMesh mesh = make_torus(5.0, 2.0, 6, 5);
  const Rigid3 move = Rigid3::about_axis(Vec3(1, -2, 2) / 3.0, Vec3(4, 5, 6), 0.7);
  TriangleMesh moved = mesh;
  for (Vec3& v : moved.vertices) v = move * v;
  const TriangleMesh a = subdivide(mesh, {.levels = 2}), b = subdivide(moved, {.levels = 2});
  for (size_t v = 0; v < a.vertices.size(); ++v) {
    EXPECT_NEAR((move * a.vertices[v] - b.vertices[v]).norm(), 0.0, 1e-9);
  }
}

TEST(Subdivide, LevelZeroOfPlainLoopIsTheInput) {
  const TriangleMesh mesh = make_box({1, 2, 3});
  const TriangleMesh result = subdivide(
      mesh, {.scheme = SubdivisionScheme::kLoop, .levels = 0, .projects_to_limit = false});
  EXPECT_EQ(result.vertices, mesh.vertices);
  EXPECT_EQ(result.triangles, mesh.triangles);
}

TEST(Subdivide, RefusesLevelsOutOfRangeAndOpenMeshesWhereTheVolumeIsKept) {
  EXPECT_THROW(subdivide(make_box({1, 1, 1}), {.levels = 7}), UsageError);
  EXPECT_THROW(subdivide(make_box({1, 1, 1}), {.fit_rounds = -1}), UsageError);
  try {
    subdivide(make_grid_patch(1, 1, 1.0));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "subdivision: the mesh has 2 triangles and 4 border edges; keeping the volume "
                 "requires a closed mesh");
  }
  EXPECT_EQ(subdivide({}, kPlainLoop).vertex_count(), 0);
}

}  // namespace
}  // namespace palmar::geometry
