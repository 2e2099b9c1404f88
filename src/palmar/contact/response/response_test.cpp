// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/response.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

TEST(DiscResponse, MeetsTheClosedFormsOfUniformPressure) {
  // Johnson 1985, section 3.4 with E* = 4 G: under F on a disc of radius a the centre moves by
  // 2 p a / E* = F / (2 pi a G), the edge by 4 p a / (pi E*) = F / (pi^2 a G).
  for (const double a : {0.5, 1.3, 4.0}) {
    EXPECT_NEAR(disc_response(0.0, a), 1.0 / (2.0 * std::numbers::pi * a), 1e-9 / a);
    EXPECT_NEAR(disc_response(a, a), 1.0 / (std::numbers::pi * std::numbers::pi * a), 1e-4 / a);
    EXPECT_NEAR(disc_response(100.0 * a, a) / point_response(100.0 * a), 1.0, 2e-5);
  }
}

TEST(DiscResponse, MeanOverTheDiscIsThatOfTheClosedForm) {
  // Mean displacement 16 p a / (3 pi E*) = 4 F / (3 pi^2 a G); midpoint rule over the radius.
  const double a = 2.0;
  constexpr int n = 4000;
  double mean = 0.0;
  for (int i = 0; i < n; ++i) {
    const double r = a * (i + 0.5) / n;
    mean += disc_response(r, a) * 2.0 * r / (a * a) * (a / n);
  }
  EXPECT_NEAR(mean, 4.0 / (3.0 * std::numbers::pi * std::numbers::pi * a), 1e-5);
}

TEST(DiscResponse, FallsSteadilyWithDistance) {
  double before = disc_response(0.0, 1.0);
  for (double r = 0.01; r < 20.0; r += 0.01) {
    const double here = disc_response(r, 1.0);
    ASSERT_LT(here, before) << "at r = " << r;
    before = here;
  }
}

TEST(PointResponse, IsHeldBelowHalfAMillimetre) {
  EXPECT_EQ(point_response(0.0), 1.0 / (4.0 * std::numbers::pi * 0.5));  // Xie 2014, eq. (3-2)
  EXPECT_EQ(point_response(0.5), point_response(0.1));
  EXPECT_NEAR(point_response(2.0), 1.0 / (8.0 * std::numbers::pi), 1e-15);
}

TEST(ShearModulus, GrowsLinearlyToItsLimit) {
  const hand::StiffeningLaw tissue{.g0 = 0.005, .g_limit = 0.085, .limit_depth = 4.0};
  EXPECT_DOUBLE_EQ(shear_modulus_at(tissue, 0.0), 0.005);
  EXPECT_DOUBLE_EQ(shear_modulus_at(tissue, 2.0), 0.045);
  EXPECT_DOUBLE_EQ(shear_modulus_at(tissue, 9.0), 0.085);
}

TEST(DiscOverlap, KnowsApartInsideAndHalfWay) {
  EXPECT_EQ(disc_overlap(3.0, 1.0, 2.0), 0.0);
  EXPECT_NEAR(disc_overlap(0.5, 1.0, 2.0), std::numbers::pi, 1e-12);
  // Two unit discs at distance 1 share 2 pi / 3 - sqrt(3) / 2.
  EXPECT_NEAR(disc_overlap(1.0, 1.0, 1.0), 2.0 * std::numbers::pi / 3.0 - std::sqrt(3.0) / 2.0,
              1e-12);
}

TEST(ResponseMatrix, IsSymmetricAndPositiveDefiniteOnIrregularSkin) {
  // Vertices of an icosphere moved about on it: areas and distances vary by a factor of two.
  auto hand = std::make_shared<hand::Hand>(*contact_test::ball_hand(10.0, 3));
  for (std::size_t v = 0; v < hand->skin.vertices.size(); ++v) {
    Vec3& q = hand->skin.vertices[v];
    const double angle = 2.4 * static_cast<double>(v);
    q += 0.35 * Vec3(std::sin(angle), std::cos(1.7 * angle), std::sin(2.9 * angle));
    q = 10.0 * q.normalized();
  }
  const PreparedHand prepared(hand);
  std::vector<int> all(hand->skin.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  const Eigen::MatrixXd R = dense_response(prepared.impl().response, all, hand->region, true);
  EXPECT_EQ((R - R.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(R, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.02 * R.diagonal().minCoeff());
  EXPECT_GE(R.minCoeff(), 0.0);
}

TEST(ArcDistance, IsExactOnSphereAndCylinder) {
  const SkinGeometry ball = skin_geometry(geometry::make_icosphere(10.0, 3));
  for (const int j : {5, 77, 300}) {
    const double angle = std::acos(ball.position[0].dot(ball.position[j]) / 100.0);
    // Vertex normals of the mesh lean from the sphere's by a little.
    EXPECT_NEAR(arc_distance(ball, 0, j), 10.0 * angle, 0.01 * 10.0 * angle);
  }
  SkinGeometry tube;
  for (const double angle : {0.0, 1.0}) {
    tube.normal.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    tube.position.push_back(8.0 * tube.normal.back() + 6.0 * angle * Vec3::UnitZ());
  }
  EXPECT_NEAR(arc_distance(tube, 0, 1), 10.0, 1e-12);  // helix: sqrt((8 * 1)^2 + 6^2)
}

TEST(VoronoiAreas, SumToTheSurface) {
  double sum = 0.0;
  for (const double a : geometry::vertex_areas(geometry::make_icosphere(10.0, 4))) sum += a;
  EXPECT_NEAR(sum, 400.0 * std::numbers::pi,
              0.004 * 400.0 * std::numbers::pi);  // facets of an inscribed polyhedron
}

}  // namespace
}  // namespace palmar::contact
