// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/geodesic/geodesic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::geometry {
namespace {

double straight(const TriangleMesh& mesh, size_t i, size_t j) {
  return (mesh.vertices[i] - mesh.vertices[j]).norm();
}

TEST(GeodesicSolver, IsExactOnAPlane) {
  const auto expect_straight = [](const TriangleMesh& mesh, size_t source) {
    const std::vector<double> d = GeodesicSolver(mesh).distances(static_cast<int>(source));
    for (size_t v = 0; v < d.size(); ++v) {
      EXPECT_NEAR(d[v], straight(mesh, source, v), 1e-6);  // mm; gains below 1e-9 edge are left
    }
  };
  expect_straight(make_lattice_patch(20.0, 1.0), 0);  // from its rim lines would leave the patch
  const TriangleMesh grid = make_grid_patch(30, 20, 0.7);
  for (const size_t source : {size_t{0}, grid.vertices.size() / 3, grid.vertices.size() - 1}) {
    expect_straight(grid, source);
  }
}

TEST(GeodesicSolver, IsNearlyExactOnAPlaneOfIrregularTriangles) {
  TriangleMesh mesh = make_lattice_patch(20.0, 1.0);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> noise(-0.25, 0.25);
  for (Vec3& v : mesh.vertices) {
    v.x() += noise(random);
    v.y() += noise(random);
  }
  const std::vector<double> d = GeodesicSolver(mesh).distances(0);
  for (size_t v = 1; v < d.size(); ++v) {
    EXPECT_NEAR(d[v] / straight(mesh, 0, v), 1.0, 0.01);
  }
}

TEST(GeodesicSolver, ConvergesToGreatCirclesOnASphere) {
  double last = 1.0;
  for (int level = 3; level <= 5; ++level) {
    const TriangleMesh mesh = make_icosphere(20.0, level);
    const std::vector<double> d = GeodesicSolver(mesh).distances(5);
    double sum = 0.0;
    for (size_t v = 0; v < d.size(); ++v) {
      const double cosine = mesh.vertices[v].dot(mesh.vertices[5]) / 400.0;
      sum += std::abs(d[v] - 20.0 * std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    const double mean = sum / static_cast<double>(d.size()) / (10.0 * std::numbers::pi);
    EXPECT_LT(mean, 0.75 * last);
    last = mean;
  }
  EXPECT_LT(last, 3e-3);  // of the mean distance, a quarter of the circumference
}

TEST(GeodesicSolver, UnrollsACylinder) {
  const int segments = 48, rings = 60;
  const TriangleMesh mesh = make_cylinder(
      {.radius = 10.0, .length = 80.0, .segments = segments, .rings = rings, .is_capped = false});
  // The mesh is a prism: its own width unrolls exactly.
  const double width = 2.0 * 10.0 * std::sin(std::numbers::pi / segments);
  const std::vector<double> d = GeodesicSolver(mesh).distances(0);
  for (int k = 0; k <= rings; ++k) {
    for (int i = 0; i < segments; ++i) {
      const double round = width * std::min(i, segments - i);
      const double exact = std::hypot(round, 80.0 * k / rings);
      EXPECT_NEAR(d[k * segments + i], exact, 0.005 * exact + 1e-9);
    }
  }
}

TEST(GeodesicSolver, GoesRoundASlit) {
  // Cut along x = 10 from y = 0 to y = 15: triangles between the columns x = 10 and x = 11 are
  // gone.
  TriangleMesh mesh = make_grid_patch(20, 20, 1.0);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    Vec3 centre = Vec3::Zero();
    for (const int v : t) centre += mesh.vertices[v] / 3.0;
    return centre.x() > 10.0 && centre.x() < 11.0 && centre.y() < 15.0;
  });
  const auto at = [](int x, int y) { return y * 21 + x; };
  const std::vector<double> d = GeodesicSolver(mesh).distances(at(5, 5));
  // Shortest path from (5, 5) over the corners (10, 15) and (11, 15) of the gap to (16, 5).
  const double round = 2.0 * std::hypot(5.0, 10.0) + 1.0;
  EXPECT_GE(d[at(16, 5)], round - 1e-6);
  EXPECT_LE(d[at(16, 5)], 1.01 * round);  // behind corners it loses up to 1 %
  // In sight: straight.
  EXPECT_NEAR(d[at(10, 9)], std::hypot(5.0, 4.0), 1e-6);
}

TEST(GeodesicSolver, NeverBeatsTheStraightLineNorTheTriangleInequality) {
  const TriangleMesh mesh = make_torus(20.0, 8.0, 60, 30);
  const GeodesicSolver solver(mesh);
  std::mt19937 random(4);
  std::vector<int> pick;
  for (int i = 0; i < 12; ++i) pick.push_back(static_cast<int>(random() % 1800U));
  std::map<int, std::vector<double>> d;
  for (const int i : pick) d[i] = solver.distances(i);
  for (const int i : pick) {
    for (const int j : pick) {
      const double ij = d[i][j];
      EXPECT_GE(ij, straight(mesh, i, j) * (1 - 1e-9));
      EXPECT_NEAR(ij, d[j][i], 0.01 * ij);
      for (const int k : pick) {
        EXPECT_LE(ij, (d[i][k] + d[k][j]) * 1.01);
      }
    }
  }
}

TEST(GeodesicSolver, ReachesExactlyWhatLiesWithinTheRadius) {
  const TriangleMesh mesh = make_lattice_patch(20.0, 1.0);
  const GeodesicSolver solver(mesh);
  GeodesicWorkspace workspace;
  const auto reached = solver.reach(0, 7.3, workspace);
  ASSERT_FALSE(reached.empty());
  EXPECT_EQ(reached[0].vertex, 0);
  EXPECT_EQ(reached[0].distance, 0.0);
  size_t within = 0;
  for (size_t v = 0; v < mesh.vertices.size(); ++v) within += straight(mesh, 0, v) <= 7.3;
  EXPECT_EQ(reached.size(), within);
  for (const GeodesicReach& r : reached) {
    EXPECT_NEAR(r.distance, straight(mesh, 0, r.vertex), 1e-6);
  }
  EXPECT_EQ(solver.reach(3, 0.0, workspace).size(), 1U);
}

TEST(GeodesicSolver, WorkspaceKeepsNothingFromCallToCall) {
  const TriangleMesh mesh = make_icosphere(10.0, 4), other = make_torus(9.0, 3.0, 20, 10);
  const GeodesicSolver solver(mesh), small(other);
  GeodesicWorkspace reused;
  for (const int source : {17, 900, 4, 17}) {
    GeodesicWorkspace fresh;
    const auto a = solver.reach(source, 5.0, reused);
    const auto b = solver.reach(source, 5.0, fresh);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].vertex, b[i].vertex);
      EXPECT_EQ(a[i].distance, b[i].distance);
    }
    EXPECT_EQ(small.reach(1, 100.0, reused).size(), other.vertices.size());
  }
}

TEST(GeodesicSolver, StaysAmongAllowedVertices) {
  const TriangleMesh mesh = make_grid_patch(20, 20, 1.0);
  std::vector<unsigned char> allowed(mesh.vertices.size(), 1);
  for (int y = 0; y < 15; ++y) allowed[y * 21 + 10] = 0;  // a wall at x = 10
  const GeodesicSolver solver(mesh);
  GeodesicWorkspace workspace;
  double far = 0.0;
  for (const auto& r : solver.reach(5 * 21 + 5, 100.0, workspace, allowed)) {
    EXPECT_TRUE(allowed[r.vertex]);
    if (r.vertex == 5 * 21 + 15) far = r.distance;
  }
  // Every triangle at (10, 14) is closed: the shortest way is over (9, 15) and (11, 15).
  const double round = 2.0 * std::hypot(4.0, 10.0) + 2.0;
  EXPECT_GE(far, round - 1e-6);
  EXPECT_LE(far, 1.01 * round);
  EXPECT_TRUE(solver.reach(10, 100.0, workspace, allowed).empty());
}

TEST(GeodesicSolver, DoesNotChangeUnderRigidMotion) {
  TriangleMesh mesh = make_torus(20.0, 8.0, 40, 20);
  const std::vector<double> before = GeodesicSolver(mesh).distances(7);
  const Rigid3 move = Rigid3::about_axis(Vec3(2, -1, 2) / 3.0, Vec3(50, 60, 70), 2.0);
  for (Vec3& v : mesh.vertices) v = move * v;
  const std::vector<double> after = GeodesicSolver(mesh).distances(7);
  for (size_t v = 0; v < before.size(); ++v) EXPECT_NEAR(before[v], after[v], 1e-6);
}

TEST(GeodesicSolver, WalksAlongTheEdgesOfNeedles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {6, 0, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}, {4, 4, 3}};
  const std::vector<double> d = GeodesicSolver(mesh).distances(0);
  EXPECT_NEAR(d[3], 6.0, 1e-12);
  EXPECT_TRUE(std::isinf(d[4]));  // the collapsed triangle is no path
}

TEST(GeodesicSolver, PassesANonManifoldEdgeIntoEverySheet) {
  TriangleMesh fan;
  fan.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {-1, 0, 0.5}, {0, 1, 0.5}};
  fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const std::vector<double> d = GeodesicSolver(fan).distances(2);
  for (const size_t v : {0U, 1U}) EXPECT_NEAR(d[v], std::hypot(1.0, 0.5), 1e-12);
  for (const size_t v : {3U, 4U}) EXPECT_NEAR(d[v], 2.0, 1e-9);
}

TEST(GeodesicSolver, RefusesASourceOutsideTheMesh) {
  const GeodesicSolver solver(make_icosphere(1.0, 0));
  GeodesicWorkspace workspace;
  try {
    solver.reach(12, 1.0, workspace);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "geodesic distance: source vertex 12; the mesh has 12 vertices");
  }
  const std::vector<unsigned char> wrong(3, 1);
  EXPECT_THROW(solver.reach(0, 1.0, workspace, wrong), UsageError);
  EXPECT_THROW(GeodesicSolver(TriangleMesh{}).distances(0), UsageError);
}

TEST(GeodesicTable, IsSymmetricAscendingAndTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = make_icosphere(15.0, 4);
  const GeodesicSolver solver(mesh);
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); v += 3) vertices.push_back(v);
  set_thread_count(1);
  const GeodesicTable one = geodesic_table(solver, vertices, 6.0);
  set_thread_count(4);
  const GeodesicTable four = geodesic_table(solver, vertices, 6.0);
  set_thread_count(0);
  EXPECT_EQ(one.begin, four.begin);
  EXPECT_EQ(one.place, four.place);
  EXPECT_EQ(one.distance, four.distance);
  std::map<std::pair<int, int>, double> entry;
  for (size_t i = 0; i < vertices.size(); ++i) {
    for (int e = one.begin[i]; e < one.begin[i + 1]; ++e) {
      if (e > one.begin[i]) {
        EXPECT_LT(one.place[e - 1], one.place[e]);
      }
      entry[{static_cast<int>(i), one.place[e]}] = one.distance[e];
    }
    EXPECT_EQ((entry[{static_cast<int>(i), static_cast<int>(i)}]), 0.0);
  }
  for (const auto& [pair, distance] : entry) {
    EXPECT_EQ(entry.at({pair.second, pair.first}), distance);
    EXPECT_LE(distance, 6.0);
  }
  EXPECT_THROW(geodesic_table(solver, std::vector<int>{1, 1}, 6.0), UsageError);
}

}  // namespace
}  // namespace palmar::geometry
