// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/skin_compliance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/bone/contact_test_layer.h"
#include "palmar/contact/bone/half_space_tensor.h"
#include "palmar/contact/bone/loaded_skin.h"
#include "palmar/contact/response/response.h"
#include "palmar/contact/solve/lcp.h"

namespace palmar::contact {
namespace {

using contact_test::BondedLayer;

Eigen::MatrixXd full(const SparseRows& rows) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k) {
      result(i, rows.column[k]) = static_cast<double>(rows.value[k]);
    }
  }
  return result;
}

TEST(HalfSpaceTensor, SpreadForcesArePointForcesFarAwayAndSofterNearby) {
  const Vec3 n = Vec3::UnitZ();
  const Vec3 far(60.0, 0.0, 0.0);
  const Eigen::Matrix3d spread = spread_tensor(far, 1.0, 2.0, n, n);
  // (I + e e^T) / (4 pi r)
  EXPECT_NEAR(spread(2, 2), point_response(60.0), 1e-3 * point_response(60.0));
  EXPECT_NEAR(spread(0, 0), 2.0 * point_response(60.0), 2e-3 * point_response(60.0));
  EXPECT_NEAR(spread(1, 1), point_response(60.0), 1e-3 * point_response(60.0));
  EXPECT_LT((disc_tensor(far, 1.0, 1.0, n, n) - spread).norm(), 1e-3 * spread.norm());
  const Eigen::Matrix3d own = spread_tensor(Vec3::Zero(), 2.0, 2.0, n, n);
  // (1 - nu) / (2 pi) Int (3 g - 3 g^2 + g^3)^2 dk by Simpson's rule.
  double sum = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double k = 5.0 * i / kSteps;
    const double g = std::exp(-0.5 * k * k * 4.0);
    const double s = 1.0 - std::pow(1.0 - g, 3);
    sum += (i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * s * s;
  }
  const double truth = sum * 5.0 / kSteps / 3.0 * 0.5 / (2.0 * std::numbers::pi);
  EXPECT_NEAR(own(2, 2), truth, 1e-4 * truth);
  EXPECT_NEAR(own(0, 0), 1.5 * truth, 1e-4 * truth);  // Cerruti, mean over the directions
}

struct SphereCase {
  double edge, thickness, radius, depth;  ///< mm
  double over_hertz;  ///< force on an incompressible bonded layer over Hertz' (integral equation)
  double tolerance;
};

/// F / F_Hertz of a rigid sphere on a bonded layer at sqrt(R depth) / h, from the integral equation
/// of Hayes et al. 1972 for nu = 1/2: 1.129, 1.518, 2.156, 5.115 at 0.1, 0.3, 0.5, 1.
class SphereOnLayer : public testing::TestWithParam<SphereCase> {};

TEST_P(SphereOnLayer, MeetsTheIntegralEquation) {
  const SphereCase& c = GetParam();
  const BondedLayer layer(c.edge, c.thickness, 20.0, 1.6, 10.0);
  const SkinCompliance compliance = layer.compliance();
  LoadedSkin loaded(layer.skin, compliance, nullptr, {});
  loaded.set(compliance.vertex, std::vector<Vec3>(compliance.vertex.size(), Vec3(0.0, 0.0, -1.0)));
  const Eigen::MatrixXd C = full(loaded.responses());
  EXPECT_EQ(C, C.transpose());
  ContactProblem problem;
  problem.response = C;
  problem.distance.resize(C.rows());
  for (int i = 0; i < C.rows(); ++i) {
    problem.distance[i] = layer.skin.position[i].squaredNorm() / (2.0 * c.radius) - c.depth;
  }
  const ContactSolution solution = solve_contact(problem);
  ASSERT_EQ(solution.status, LcpStatus::kSolved);
  const double hertz = 16.0 / 3.0 * std::sqrt(c.radius) * std::pow(c.depth, 1.5);
  EXPECT_NEAR(solution.force.sum() / hertz, c.over_hertz, c.tolerance * c.over_hertz);
}

// Layers of two to five elements; thick ones tend to Hertz.
INSTANTIATE_TEST_SUITE_P(ThinToThick, SphereOnLayer,
                         testing::Values(SphereCase{2.0, 5.0, 12.5, 2.0, 5.115, 0.10},
                                         SphereCase{1.5, 5.0, 12.5, 2.0, 5.115, 0.10},
                                         SphereCase{2.0, 10.0, 12.5, 2.0, 2.156, 0.07},
                                         SphereCase{2.0, 15.0, 10.0, 2.025, 1.518, 0.06}));

TEST(LoadedSkin, DisplacementOfOtherVerticesIsTheirRowOfTheMatrix) {
  const BondedLayer layer(2.0, 5.0, 14.0, 2.0, 8.0);
  const SkinCompliance compliance = layer.compliance();
  LoadedSkin all(layer.skin, compliance, nullptr, {});
  const auto count = compliance.vertex.size();
  std::vector<Vec3> direction;
  for (std::size_t i = 0; i < count; ++i) {
    direction.push_back(Vec3(0.3 * std::sin(3.0 * static_cast<double>(i)), 0.2, -1.0).normalized());
  }
  all.set(compliance.vertex, direction);
  const std::vector<int> some(compliance.vertex.begin(), compliance.vertex.begin() + 20);
  const std::vector<int> others(compliance.vertex.begin() + 20, compliance.vertex.end());
  LoadedSkin part(layer.skin, compliance, nullptr, {});
  part.set(some, {direction.begin(), direction.begin() + 20});
  const Eigen::MatrixXd C = full(all.responses());
  std::vector<double> force(20);
  for (std::size_t j = 0; j < force.size(); ++j) force[j] = 1.0 + 0.1 * static_cast<double>(j);
  const std::vector<double> moved =
      part.displacement(force, others, {direction.begin() + 20, direction.end()});
  for (std::size_t i = 0; i < others.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < force.size(); ++j) {
      sum += force[j] * C(static_cast<int>(i) + 20, static_cast<int>(j));
    }
    EXPECT_NEAR(moved[i], sum, 1e-4);
  }
}

TEST(CompactPatches, HoldEveryPointOnce) {
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(i, 0.0, 0.0);
  int count = 0;
  const std::vector<int> patch = compact_patches(points, 10, count);
  ASSERT_EQ(count, 4);
  std::vector<int> size(4, 0);
  for (const int p : patch) ++size[p];
  EXPECT_EQ(size, std::vector<int>(4, 10));
}

TEST(PatchMatrix, PairsWithoutABlockAreZeroAndTheRestSymmetric) {
  PatchMatrix A({0, 0, 1, 2}, 3, {{0}, {0, 1}, {1, 2}});
  A.block(0, 0)(0, 0) = 7.0;
  A.block(1, 0)(0, 1) = 3.0;
  EXPECT_EQ(A(0, 0), 7.0);
  EXPECT_EQ(A(2, 1), 3.0);
  EXPECT_EQ(A(1, 2), 3.0);
  EXPECT_EQ(A(3, 0), 0.0);
  Eigen::VectorXd x(4);
  x << 1.0, 2.0, 5.0, 1.0;
  Eigen::VectorXd y(4);
  y << 7.0, 15.0, 6.0, 0.0;
  EXPECT_EQ(A * x, y);
}

}  // namespace
}  // namespace palmar::contact
