// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/geodesic/isomap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using testing::HasSubstr;

MatrixXd straight_distances(const std::vector<Vec3>& points) {
  const auto n = static_cast<Index>(points.size());
  MatrixXd d(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      d(i, j) = (points[i] - points[j]).norm();
    }
  }
  return d;
}

MatrixXd flat_distances(const FlatPatch& flat) {
  const Index n = flat.position.rows();
  MatrixXd d(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) d(i, j) = (flat.position.row(i) - flat.position.row(j)).norm();
  }
  return d;
}

double largest_difference(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

std::vector<int> all_vertices(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

template <typename Body>
std::string message_of(const Body& body) {
  try {
    body();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Isomap, FlatPatchKeepsItsDistances) {
  for (const TriangleMesh& mesh :
       {make_grid_patch(30, 17, 1.3), make_grid_patch(20, 20, 2.5), make_grid_patch(2, 1, 4.0)}) {
    const MatrixXd d = straight_distances(mesh.vertices);
    const FlatPatch flat = flatten_by_isomap(d);
    EXPECT_LT(largest_difference(flat_distances(flat), d), 1e-9);  // mm, rounding
    EXPECT_LT(flat.residual_variance, 1e-12);
    EXPECT_LT(flat.position.colwise().mean().norm(), 1e-10);
  }
}

TEST(Isomap, CylinderPatchUnrolls) {
  // Arc distances on a cylinder are those of the unrolled rectangle: a half turn of radius 8 mm.
  constexpr double kRadius = 8.0;
  std::vector<Vec3> unrolled, on_cylinder;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 24; ++j) {
      const double angle = std::numbers::pi * i / 20.0;
      unrolled.emplace_back(kRadius * angle, 1.5 * j, 0.0);
      on_cylinder.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), 1.5 * j);
    }
  }
  const MatrixXd arc = straight_distances(unrolled);
  const FlatPatch flat = flatten_by_isomap(arc);
  EXPECT_LT(largest_difference(flat_distances(flat), arc), 1e-9);
  // Straight lines through the solid are no isometry of a plane: the residual shows.
  EXPECT_GT(flatten_by_isomap(straight_distances(on_cylinder)).residual_variance, 1e-3);
}

TEST(Isomap, SphereCapIsTooLongRoundItsRimAndTooShortAcross) {
  // A circle at the polar angle t of a sphere of radius R is 2 pi R sin t long, less than the
  // 2 pi R t that it gets in a plane with true radii: no flat picture is true to both (Gauss), so
  // it comes out between them.
  constexpr double kRadius = 10.0;
  std::vector<Vec3> points = {Vec3(0, 0, kRadius)};
  constexpr int kRings = 8, kAround = 24;
  for (int ring = 1; ring <= kRings; ++ring) {
    const double t = 1.2 * ring / kRings;
    for (int k = 0; k < kAround; ++k) {
      const double phi = 2.0 * std::numbers::pi * k / kAround;
      points.emplace_back(
          kRadius * Vec3(std::sin(t) * std::cos(phi), std::sin(t) * std::sin(phi), std::cos(t)));
    }
  }
  MatrixXd d = straight_distances(points);
  for (Index i = 0; i < d.size(); ++i) {
    d.data()[i] = 2.0 * kRadius * std::asin(0.5 * d.data()[i] / kRadius);
  }
  const FlatPatch flat = flatten_by_isomap(d);
  const MatrixXd f = flat_distances(flat);
  const Index rim = d.rows() - kAround;
  EXPECT_LT(f(0, rim), d(0, rim));                // radius of the rim: too short
  EXPECT_GT(f(0, rim), kRadius * std::sin(1.2));  // but longer than its circle asks for
  EXPECT_GT(f(rim, rim + 1), d(rim, rim + 1));    // along the rim: too long
  EXPECT_GT(flat.residual_variance, 1e-4);
  EXPECT_LT(flat.residual_variance, 0.05);
}

TEST(Isomap, PointsOnALineStayOnIt) {
  const FlatPatch flat =
      flatten_by_isomap(straight_distances({Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(7, 0, 0)}));
  EXPECT_NEAR(std::abs(flat.position(2, 0) - flat.position(0, 0)), 7.0, 1e-12);
  EXPECT_EQ(flat.position.col(1).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(flatten_by_isomap(MatrixXd::Zero(1, 1)).position.norm(), 0.0);
}

TEST(Isomap, PointsAllEquallyFarApartHaveAPictureToo) {
  // Every direction is as good as every other; the residual says that the plane is a poor one.
  MatrixXd d = MatrixXd::Constant(60, 60, 5.0);
  d.diagonal().setZero();
  const FlatPatch flat = flatten_by_isomap(d);
  EXPECT_TRUE(flat.position.allFinite());
}

TEST(Isomap, OrderAndSignAreFixed) {
  const MatrixXd d = straight_distances(make_grid_patch(19, 7, 1.0).vertices);
  const FlatPatch first = flatten_by_isomap(d), second = flatten_by_isomap(d);
  EXPECT_TRUE(first.position == second.position);
  // Long direction first; the first corner is among the largest entries of both.
  EXPECT_NEAR(first.position(0, 0), 9.5, 1e-9);
  EXPECT_NEAR(first.position(0, 1), 3.5, 1e-9);
}

TEST(Isomap, RefusesTablesThatAreNone) {
  MatrixXd d = MatrixXd::Constant(3, 3, 2.0);
  d.diagonal().setZero();
  MatrixXd bad = d;
  bad(0, 2) = bad(2, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message_of([&] { flatten_by_isomap(bad); }),
              HasSubstr("points 0 and 2 is infinite; a patch in one piece is required"));
  bad = d;
  bad(2, 1) = 2.5;
  EXPECT_THAT(message_of([&] { flatten_by_isomap(bad); }), HasSubstr("a symmetric table"));
  bad = d;
  bad(1, 1) = 1.0;
  EXPECT_THAT(message_of([&] { flatten_by_isomap(bad); }), HasSubstr("0 mm is required"));
  bad = d;
  bad(0, 1) = bad(1, 0) = -1.0;
  EXPECT_THAT(message_of([&] { flatten_by_isomap(bad); }), HasSubstr("0 mm or more is required"));
  EXPECT_THAT(message_of([&] { flatten_by_isomap(MatrixXd(2, 3)); }), HasSubstr("2 x 3"));
  EXPECT_THAT(message_of([&] { flatten_by_isomap(MatrixXd(0, 0)); }), HasSubstr("0 x 0"));
}

TEST(EdgePaths, FollowTheEdgesOfALattice) {
  // On equilateral triangles a path from the centre takes steps along two lattice directions:
  // straight along an edge, 2 / sqrt(3) = 1.155 times too long half-way between two.
  const TriangleMesh mesh = make_lattice_patch(10.5, 1.0);
  const std::vector<int> all = all_vertices(mesh);
  const MatrixXd d = edge_path_distances(mesh, all);
  EXPECT_EQ(d, d.transpose());
  double worst = 0.0;
  for (std::size_t v = 1; v < all.size(); ++v) {
    const double ratio = d(0, static_cast<Index>(v)) / mesh.vertices[v].norm();
    EXPECT_GT(ratio, 1.0 - 1e-12);
    worst = std::max(worst, ratio);
  }
  EXPECT_NEAR(worst, 2.0 / std::sqrt(3.0), 1e-9);
}

TEST(EdgePaths, KeepInsideThePatch) {
  // A bent strip of a grid: from end to end round the corner, not across.
  const TriangleMesh mesh = make_grid_patch(10, 10, 1.0);
  std::vector<int> strip;
  for (int i = 0; i <= 10; ++i) strip.push_back(i);                               // y = 0
  for (int i = 0; i <= 10; ++i) strip.push_back(11 + i);                          // y = 1
  for (int j = 2; j <= 10; ++j) strip.insert(strip.end(), {11 * j, 11 * j + 1});  // x = 0, 1
  const MatrixXd d = edge_path_distances(mesh, strip);
  const Index last = d.rows() - 2;  // (0, 10)
  EXPECT_GT(d(10, last), 18.0);     // straight: 14.1
  EXPECT_LE(d(10, last), 20.0);
}

TEST(EdgePaths, RefusePatchesInPiecesAndStrangeVertices) {
  const TriangleMesh mesh = make_grid_patch(5, 1, 1.0);  // row 0: 0 to 5, row 1: 6 to 11
  const std::vector<int> pieces = {0, 1, 6, 7, 4, 5, 10, 11};
  EXPECT_THAT(message_of([&] { edge_path_distances(mesh, pieces); }),
              HasSubstr("no path between vertices 0 and 4; a patch in one piece is required"));
  const std::vector<int> twice = {0, 1, 0};
  EXPECT_THAT(message_of([&] { edge_path_distances(mesh, twice); }), HasSubstr("given twice"));
  const std::vector<int> outside = {0, 12};
  EXPECT_THAT(message_of([&] { edge_path_distances(mesh, outside); }),
              HasSubstr("vertex 12 is outside the mesh of 12 vertices"));
}

TEST(EdgePaths, SameBytesForOneThreadAndTwo) {
  const TriangleMesh mesh = make_icosphere(10.0, 2);
  const std::vector<int> all = all_vertices(mesh);
  set_thread_count(1);
  const MatrixXd one = edge_path_distances(mesh, all);
  set_thread_count(2);
  const MatrixXd two = edge_path_distances(mesh, all);
  set_thread_count(0);
  EXPECT_TRUE(one == two);
}

}  // namespace
}  // namespace palmar::geometry
