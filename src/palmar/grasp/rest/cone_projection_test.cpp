// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/cone_projection.h"

#include <gtest/gtest.h>

#include <random>

namespace palmar::grasp {
namespace {

TEST(ConeProjection, FirstQuadrantKeepsWhatIsPositive) {
  const ConeProjection found =
      project_on_cone(Eigen::MatrixXd::Identity(3, 3), Eigen::VectorXd{{2, -3, 1}});
  EXPECT_TRUE(found.has_converged);
  EXPECT_NEAR((found.x - Eigen::VectorXd{{2, 0, 1}}).norm(), 0.0, 1e-12);
  EXPECT_NEAR((found.rest - Eigen::VectorXd{{0, -3, 0}}).norm(), 0.0, 1e-12);
}

TEST(ConeProjection, PointOfTheConeLeavesNothing) {
  Eigen::MatrixXd A(2, 3);
  A << 1, 1, 0, 0, 1, 1;
  EXPECT_NEAR(project_on_cone(A, Eigen::VectorXd{{3, 2}}).rest.norm(), 0.0, 1e-12);
}

TEST(ConeProjection, SatisfiesItsConditionsOnRandomCones) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::MatrixXd A(6, 4 + trial);
    Eigen::VectorXd b(6);
    for (Eigen::Index i = 0; i < 6; ++i) {
      b[i] = normal(random);
      for (Eigen::Index j = 0; j < A.cols(); ++j) A(i, j) = normal(random) + (i == 0 ? 2.0 : 0.0);
    }
    const ConeProjection found = project_on_cone(A, b);
    ASSERT_TRUE(found.has_converged);
    EXPECT_GE(found.x.minCoeff(), 0.0);
    EXPECT_NEAR((b - A * found.x - found.rest).norm(), 0.0, 1e-10);
    EXPECT_LE((A.transpose() * found.rest).maxCoeff(), 1e-8);
    EXPECT_NEAR(b.dot(found.rest), found.rest.squaredNorm(), 1e-8);
  }
}

}  // namespace
}  // namespace palmar::grasp
