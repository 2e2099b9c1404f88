// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/mesh_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::geometry {
namespace {

TriangleMesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(SignedVolume, IsNegativeForATurnedMeshAndIndependentOfPosition) {
  TriangleMesh mesh = make_box({2.0, 3.0, 4.0});
  for (Vec3& v : mesh.vertices) v += Vec3(1e6, -1e6, 1e6);
  EXPECT_NEAR(signed_volume(mesh), 24.0, 1e-6);  // 1e6 mm away leaves 10 digits of a coordinate
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(signed_volume(mesh), -24.0, 1e-6);
}

TEST(Measures, OfAnEmptyMeshAreZero) {
  const TriangleMesh empty;
  EXPECT_EQ(surface_area(empty), 0.0);
  EXPECT_EQ(signed_volume(empty), 0.0);
  EXPECT_TRUE(bounding_box(empty).isEmpty());
  EXPECT_TRUE(vertex_normals(empty).empty());
  EXPECT_TRUE(vertex_areas(empty).empty());
  EXPECT_EQ(edge_lengths(empty).count, 0);
}

TEST(VertexNormals, AtTheCornersOfACubeAreDiagonalHoweverTheFacesAreCut) {
  const TriangleMesh mesh = make_box({1.0, 1.0, 1.0});
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (size_t v = 0; v < normals.size(); ++v) {
    EXPECT_NEAR((normals[v] - mesh.vertices[v].normalized()).norm(), 0.0, 1e-14);
  }
}

TEST(VertexNormals, OnASphereConvergeToTheRadiusWithTheEdge) {
  double last = 1.0;
  for (int level = 2; level <= 4; ++level) {
    const TriangleMesh mesh = make_icosphere(5.0, level);
    const std::vector<Vec3> normals = vertex_normals(mesh);
    double worst = 0.0;
    for (size_t v = 0; v < normals.size(); ++v) {
      worst = std::max(worst, (normals[v] - mesh.vertices[v] / 5.0).norm());
    }
    EXPECT_LT(worst, last / 1.9);  // halves with the edge
    last = worst;
  }
}

TEST(VertexNormals, TurnWithTheMesh) {
  TriangleMesh mesh = make_torus(5.0, 2.0, 9, 7);
  const std::vector<Vec3> before = vertex_normals(mesh);
  const Rigid3 move = Rigid3::about_axis(Vec3(1, 2, 3).normalized(), Vec3(4, 5, 6), 1.1);
  for (Vec3& v : mesh.vertices) v = move * v;
  const std::vector<Vec3> after = vertex_normals(mesh);
  for (size_t v = 0; v < before.size(); ++v) {
    EXPECT_NEAR((after[v] - move.rotation * before[v]).norm(), 0.0, 1e-13);
  }
}

TEST(Normals, OfDegenerateTrianglesAreZero) {
  const TriangleMesh line = triangle({0, 0, 0}, {1, 0, 0}, {3, 0, 0});
  EXPECT_EQ(triangle_normals(line)[0], Vec3::Zero());
  for (const Vec3& n : vertex_normals(line)) EXPECT_EQ(n, Vec3::Zero());
}

TEST(VertexAreas, OfARightTriangleSplitAtTheMidpointOfTheHypotenuse) {
  // Circumcentre = middle of the hypotenuse: half of the area at the right angle, a quarter each
  // at the others.
  const std::vector<double> areas = vertex_areas(triangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}));
  EXPECT_NEAR(areas[0], 3.0, 1e-14);
  EXPECT_NEAR(areas[1], 1.5, 1e-14);
  EXPECT_NEAR(areas[2], 1.5, 1e-14);
}

TEST(VertexAreas, OfAnObtuseTriangleAreHalfAndQuarters) {
  const std::vector<double> areas = vertex_areas(triangle({0, 0, 0}, {4, 0, 0}, {-3, 1, 0}));
  EXPECT_NEAR(areas[0], 1.0, 1e-14);  // area 2; obtuse at the first corner
  EXPECT_NEAR(areas[1], 0.5, 1e-14);
  EXPECT_NEAR(areas[2], 0.5, 1e-14);
}

TEST(VertexAreas, OfAnAcuteTriangleFollowTheCircumcentre) {
  // Isosceles, base 2, height 3: circumcentre at height 4/3 (R = 5/3). The apex' part is twice the
  // right triangle with legs half of the flank and its distance to the circumcentre.
  const double flank = std::sqrt(10.0);
  const double apex = flank / 2.0 * std::sqrt(25.0 / 9.0 - 10.0 / 4.0);
  const std::vector<double> areas = vertex_areas(triangle({-1, 0, 0}, {1, 0, 0}, {0, 3, 0}));
  EXPECT_NEAR(areas[2], apex, 1e-14);
  EXPECT_NEAR(areas[0], (3.0 - apex) / 2.0, 1e-14);
  EXPECT_NEAR(areas[1], (3.0 - apex) / 2.0, 1e-14);
}

TEST(VertexAreas, SumToTheSurfaceArea) {
  for (const TriangleMesh& mesh : {make_torus(5.0, 2.0, 9, 40), make_icosphere(3.0, 3),
                                   make_cylinder({.radius = 3, .length = 50, .segments = 11})}) {
    EXPECT_NEAR(sum(vertex_areas(mesh)) / surface_area(mesh), 1.0, 1e-13);
    for (const double a : vertex_areas(mesh)) EXPECT_GT(a, 0.0);
  }
}

TEST(SmallestAngles, OfAThreeFourFiveTriangle) {
  EXPECT_NEAR(smallest_angles(triangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}))[0], std::atan2(3.0, 4.0),
              1e-15);
  EXPECT_EQ(smallest_angles(triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}))[0], 0.0);
}

TEST(EdgeLengths, OfASquareCutInTwo) {
  const EdgeLengths lengths = edge_lengths(make_grid_patch(1, 1, 2.0));
  EXPECT_EQ(lengths.count, 5);
  EXPECT_NEAR(lengths.mean, (8.0 + 2.0 * std::sqrt(2.0)) / 5.0, 1e-14);
  EXPECT_EQ(lengths.shortest, 2.0);
  EXPECT_NEAR(lengths.longest, 2.0 * std::sqrt(2.0), 1e-15);
  // Four of 2, one of 2 sqrt 2: standard deviation (2 sqrt 2 - 2) * 2 / 5.
  EXPECT_NEAR(lengths.standard_deviation, (2.0 * std::sqrt(2.0) - 2.0) * 0.4, 1e-14);
}

TEST(BoundingBox, HoldsUnusedVerticesToo) {
  TriangleMesh mesh = make_box({2, 2, 2});
  mesh.vertices.emplace_back(5, 0, 0);
  EXPECT_EQ(bounding_box(mesh).max(), Vec3(5, 1, 1));
}

TEST(MeshMeasures, CentreOfVolumeIsTheCentreOfMass) {
  // A box with a second, separate one of an eighth of its volume: lever rule.
  TriangleMesh mesh = make_box({2, 2, 2}, 3);
  const TriangleMesh small = make_box({1, 1, 1});
  const int first = mesh.vertex_count();
  for (const Vec3& v : small.vertices) mesh.vertices.push_back(v + Vec3(9, 0, 0));
  for (const Triangle& t : small.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  EXPECT_LT((centre_of_volume(mesh) - Vec3(1, 0, 0)).norm(), 1e-12);
  // An open sheet: centre of its area, however uneven its vertices.
  EXPECT_LT((centre_of_volume(make_grid_patch(4, 2, 1.5)) - Vec3(3, 1.5, 0)).norm(), 1e-12);
  EXPECT_EQ(centre_of_volume(TriangleMesh{}).norm(), 0.0);
}

TEST(AreaWeightedNormals, FollowTheLargerFaceWhereThoseByAngleLieBetweenThem) {
  // Two right angles meet in the first vertex: of area 3 towards z, of area 1/2 towards y.
  const std::vector<Vec3> vertices = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}, {1, 0, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 3, 4}};
  const std::vector<Vec3> by_area = area_weighted_normals(vertices, triangles);
  EXPECT_LT((by_area[0] - Vec3(0.0, 1.0, 6.0).normalized()).norm(), 1e-14);
  EXPECT_LT((vertex_normals(vertices, triangles)[0] - Vec3(0.0, 1.0, 1.0).normalized()).norm(),
            1e-14);
  // Without a triangle of any area: unit z.
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<Triangle> line = {{0, 1, 2}};
  EXPECT_EQ(area_weighted_normals(flat, line)[1], Vec3::UnitZ());
}

}  // namespace
}  // namespace palmar::geometry
