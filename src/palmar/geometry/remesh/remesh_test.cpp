// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/remesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/self_intersection.h"

namespace palmar::geometry {
namespace {

double smallest_angle(const TriangleMesh& mesh) {
  const std::vector<double> angles = smallest_angles(mesh);
  return *std::min_element(angles.begin(), angles.end());
}

TEST(Remesh, MakesEvenTrianglesOfTheWantedSizeOnASphere) {
  const TriangleMesh sphere = make_icosphere(20.0, 4);  // edges of 1.4 mm
  for (const double edge : {1.0, 1.5, 2.5}) {
    const RemeshResult result = remesh(sphere, {.edge_length = edge});
    const TopologyReport report = examine_topology(result.mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
    EXPECT_EQ(report.euler_number, 2);
    EXPECT_NEAR(edge_lengths(result.mesh).mean, edge, 0.04 * edge);
    EXPECT_GT(smallest_angle(result.mesh), 30.0 * kDegree);
    EXPECT_TRUE(find_self_crossings(result.mesh).empty());
  }
}

TEST(Remesh, VerticesLieOnTheInputAtTheRequestedSpacing) {
  const TriangleMesh torus = make_torus(30.0, 8.0, 90, 30);
  const RemeshResult result = remesh(torus, {.edge_length = 3.0});
  EXPECT_EQ(examine_topology(result.mesh).euler_number, 0);
  ASSERT_EQ(result.triangle.size(), result.mesh.vertices.size());
  for (size_t v = 0; v < result.triangle.size(); ++v) {
    Vec3 p = Vec3::Zero();
    for (size_t k = 0; k < 3; ++k) {
      const int corner = torus.triangles[result.triangle[v]][k];
      p += result.weights[v][k] * torus.vertices[corner];
    }
    EXPECT_NEAR((p - result.mesh.vertices[v]).norm(), 0.0, 1e-9);
  }
  EXPECT_NEAR(signed_volume(result.mesh) / signed_volume(torus), 1.0, 0.03);
}

TEST(Remesh, DoesNotJumpBetweenTwoSheetsThatAreCloserThanAnEdge) {
  // A box 0.4 mm thick under edges of 2 mm: opposite faces must stay apart.
  const TriangleMesh plate = make_box({40.0, 40.0, 0.4}, 40);
  const RemeshResult result = remesh(plate, {.edge_length = 2.0});
  const TopologyReport report = examine_topology(result.mesh);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
  EXPECT_EQ(report.euler_number, 2);
  // The faces stay; the sharp rim may retreat by about an edge: (40 - 2 * 2.5)^2 * 0.4 = 490 mm^3.
  EXPECT_GT(signed_volume(result.mesh), 490.0);
  EXPECT_LT(signed_volume(result.mesh), 640.0);
}

TEST(Remesh, KeepsTwoBallsApartThatAlmostTouch) {
  TriangleMesh balls = make_icosphere(10.0, 4);
  const int count = balls.vertex_count();
  for (int v = 0; v < count; ++v) {
    balls.vertices.push_back(balls.vertices[v] + Vec3(20.05, 0.0, 0.0));
  }
  for (int t = 0; t < 20 * 256; ++t) {
    const auto [a, b, c] = balls.triangles[t];
    balls.triangles.push_back({a + count, b + count, c + count});
  }
  const RemeshResult result = remesh(balls, {.edge_length = 2.0});
  EXPECT_EQ(examine_topology(result.mesh).components, 2);
  EXPECT_TRUE(find_self_crossings(result.mesh).empty());
  for (size_t v = 0; v < result.triangle.size(); ++v) {
    const double x = result.triangle[v] < 20 * 256 ? 0.0 : 20.05;
    EXPECT_NEAR((result.mesh.vertices[v] - Vec3(x, 0.0, 0.0)).norm(), 10.0, 0.05);
  }
  const std::vector<int> component = triangle_components(result.mesh, build_topology(result.mesh));
  for (size_t t = 0; t < component.size(); ++t) {
    for (const int v : result.mesh.triangles[t]) {
      const bool is_second = result.triangle[v] >= 20 * 256;
      EXPECT_EQ(is_second, result.mesh.vertices[v].x() > 10.025);
      EXPECT_EQ(component[t] == component[0],
                is_second == (result.mesh.vertices[result.mesh.triangles[0][0]].x() > 10.025));
    }
  }
}

TEST(Remesh, LeavesBordersWhereTheyAre) {
  const TriangleMesh patch = make_grid_patch(20, 10, 1.0);
  const RemeshResult result = remesh(patch, {.edge_length = 0.7});
  const TopologyReport report = examine_topology(result.mesh);
  EXPECT_EQ(report.euler_number, 1);
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_NEAR(surface_area(result.mesh), 200.0, 1e-9);
  EXPECT_GT(smallest_angle(result.mesh), 15.0 * kDegree);
}

TEST(Remesh, IsTheSameEveryTime) {
  const TriangleMesh sphere = make_icosphere(10.0, 3);
  const RemeshResult a = remesh(sphere, {.edge_length = 1.3});
  const RemeshResult b = remesh(sphere, {.edge_length = 1.3});
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
}

TEST(Remesh, WithoutRoundsKeepsTheShape) {
  const TriangleMesh sphere = make_icosphere(10.0, 2);
  const RemeshResult result = remesh(sphere, {.edge_length = 1.0, .rounds = 0});
  EXPECT_EQ(result.mesh.vertex_count(), sphere.vertex_count());
  EXPECT_NEAR(signed_volume(result.mesh), signed_volume(sphere), 1e-9);
}

TEST(Remesh, RefusesBadOptionsAndMeshes) {
  const TriangleMesh sphere = make_icosphere(10.0, 1);
  EXPECT_THROW(remesh(sphere, {.edge_length = 0.0}), UsageError);
  EXPECT_THROW(remesh(sphere, {.edge_length = std::nan("")}), UsageError);
  EXPECT_THROW(remesh(sphere, {.rounds = 101}), UsageError);
  TriangleMesh broken = sphere;
  std::swap(broken.triangles[0][0], broken.triangles[0][1]);
  EXPECT_THROW(remesh(broken), InputError);
  broken = sphere;
  broken.vertices[0].x() = std::nan("");
  EXPECT_THROW(remesh(broken), InputError);
  EXPECT_EQ(remesh({}).mesh.vertex_count(), 0);
}

}  // namespace
}  // namespace palmar::geometry
