// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/linear_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

TEST(LinearProgram, TextbookProblemHasItsOptimum) {
  // Dantzig's product mix: max 3 x + 5 y, x <= 4, 2 y <= 12, 3 x + 2 y <= 18: 36 at (2, 6)
  // (Hillier, Lieberman, Introduction to Operations Research, Wyndor Glass).
  Eigen::MatrixXd A(3, 5);
  A << 1, 0, 1, 0, 0, 0, 2, 0, 1, 0, 3, 2, 0, 0, 1;
  const ProgramSolution found =
      solve_linear_program(Eigen::VectorXd{{-3, -5, 0, 0, 0}}, A, Eigen::VectorXd{{4, 12, 18}});
  ASSERT_EQ(found.status, ProgramStatus::kOptimal);
  EXPECT_NEAR(found.value, -36.0, 1e-12);
  EXPECT_NEAR(found.x[0], 2.0, 1e-12);
  EXPECT_NEAR(found.x[1], 6.0, 1e-12);
  // Shadow prices 0, 3/2, 1.
  EXPECT_NEAR(found.dual[0], 0.0, 1e-12);
  EXPECT_NEAR(found.dual[1], -1.5, 1e-12);
  EXPECT_NEAR(found.dual[2], -1.0, 1e-12);
}

TEST(LinearProgram, DegenerateProblemEnds) {
  // Beale 1955: cycles for ever with Dantzig's rule alone; optimum -1/20.
  Eigen::MatrixXd A(3, 7);
  A << 0.25, -60, -1.0 / 25, 9, 1, 0, 0, 0.5, -90, -1.0 / 50, 3, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const ProgramSolution found = solve_linear_program(
      Eigen::VectorXd{{-0.75, 150, -0.02, 6, 0, 0, 0}}, A, Eigen::VectorXd{{0, 0, 1}});
  ASSERT_EQ(found.status, ProgramStatus::kOptimal);
  EXPECT_NEAR(found.value, -0.05, 1e-12);
}

TEST(LinearProgram, InfeasibleProblemIsProven) {
  Eigen::MatrixXd A(2, 3);
  A << 1, 2, 1, -1, -2, 1;
  const Eigen::VectorXd b{{-1, -1}};
  const ProgramSolution found = solve_linear_program(Eigen::VectorXd::Ones(3), A, b);
  ASSERT_EQ(found.status, ProgramStatus::kInfeasible);
  EXPECT_GT(b.dot(found.dual), 0.0);
  EXPECT_LE((A.transpose() * found.dual).maxCoeff(), 1e-9);
}

TEST(LinearProgram, UnboundedProblemIsNamed) {
  Eigen::MatrixXd A(1, 2);
  A << 1, -1;
  const ProgramSolution found =
      solve_linear_program(Eigen::VectorXd{{-1, 0}}, A, Eigen::VectorXd{{1}});
  EXPECT_EQ(found.status, ProgramStatus::kUnbounded);
}

TEST(LinearProgram, RedundantRowsAreAllowed) {
  Eigen::MatrixXd A(3, 3);
  A << 1, 1, 0, 2, 2, 0, 0, 1, 1;
  const ProgramSolution found =
      solve_linear_program(Eigen::VectorXd{{1, 2, 1}}, A, Eigen::VectorXd{{1, 2, 1}});
  ASSERT_EQ(found.status, ProgramStatus::kOptimal);
  EXPECT_NEAR(found.value, 2.0, 1e-12);  // (1, 0, 1), or (0, 1, 0)
  EXPECT_LT(found.residual, 1e-12);
}

TEST(LinearProgram, PrimalAndDualAgreeOnRandomProblems) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::MatrixXd A(6, 80);
    Eigen::VectorXd x(80), c(80);
    for (Eigen::Index j = 0; j < 80; ++j) {
      for (Eigen::Index i = 0; i < 6; ++i) A(i, j) = unit(random);
      x[j] = std::max(0.0, unit(random));
      c[j] = 1.0 + unit(random);  // >= 0: bounded
    }
    const Eigen::VectorXd b = A * x;
    const ProgramSolution found = solve_linear_program(c, A, b);
    ASSERT_EQ(found.status, ProgramStatus::kOptimal);
    EXPECT_GE(found.x.minCoeff(), 0.0);
    EXPECT_LT(found.residual, 1e-9);
    EXPECT_NEAR(b.dot(found.dual), found.value, 1e-8);
    EXPECT_GE((c - A.transpose() * found.dual).minCoeff(), -1e-8);
    EXPECT_LE(found.value, c.dot(x) + 1e-9);
  }
}

TEST(LinearProgram, RefusesSizesThatDoNotFit) {
  try {
    solve_linear_program(Eigen::VectorXd::Ones(2), Eigen::MatrixXd::Ones(2, 3),
                         Eigen::VectorXd::Ones(2));
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("2 costs"));
  }
}

}  // namespace
}  // namespace palmar::grasp
