// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/packed_cholesky.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palmar::contact {
namespace {

/// Positive definite: 1 / (1 + |i - j|) is a convex decreasing Toeplitz matrix (Polya).
Eigen::MatrixXd polya(int n) {
  Eigen::MatrixXd R(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) R(i, j) = 1.0 / (1.0 + std::abs(i - j));
  }
  return R;
}

double residual(const Eigen::MatrixXd& R, const std::vector<int>& set, const Eigen::VectorXd& x) {
  const Eigen::MatrixXd block = R(set, set);
  return (block * x - Eigen::VectorXd::Ones(x.size())).cwiseAbs().maxCoeff();
}

TEST(PackedCholesky, SolvesBlocksOneAfterTheOther) {
  // Sizes around multiples of four, sets that share 0 to all rows with the one before.
  const Eigen::MatrixXd R = polya(40);
  PackedCholesky factor;
  const std::vector<std::vector<int>> sets = {{7},
                                              {7, 3, 9},
                                              {7, 3, 9, 1, 30},
                                              {7, 3, 9, 1, 31, 12, 5, 0, 39},
                                              {7, 3, 9, 1},
                                              {7, 3, 9, 1, 31, 12, 5, 2},
                                              {4, 3, 9, 1, 31, 12}};
  for (const std::vector<int>& set : sets) {
    ASSERT_TRUE(factor.factor(R, set));
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(set.size()));
    EXPECT_LT(residual(R, set, factor.solve(ones)), 1e-13) << set.size();
  }
}

TEST(PackedCholesky, RefusesAnIndefiniteBlockAndStartsAfresh) {
  Eigen::MatrixXd R = polya(8);
  R(5, 5) = -1.0;
  PackedCholesky factor;
  EXPECT_FALSE(factor.factor(R, {0, 1, 2, 3, 4, 5}));
  ASSERT_TRUE(factor.factor(R, {0, 1, 2, 3, 4}));
  EXPECT_LT(residual(R, {0, 1, 2, 3, 4}, factor.solve(Eigen::VectorXd::Ones(5))), 1e-13);
}

}  // namespace
}  // namespace palmar::contact
