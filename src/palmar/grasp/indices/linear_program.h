// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palmar::grasp {

enum class ProgramStatus { kOptimal, kInfeasible, kUnbounded, kNotConverged };

/// Solution of a linear program.
struct ProgramSolution {
  ProgramStatus status = ProgramStatus::kNotConverged;
  Eigen::VectorXd x;   ///< n; of no meaning unless optimal
  double value = 0.0;  ///< c . x
  /// m. Optimal: the dual y, A^T y <= c, b . y = value. Infeasible: a proof of it, A^T y <= 0 with
  /// b . y > 0.
  Eigen::VectorXd dual;
  double residual = 0.0;  ///< max |A x - b|, recomputed
  int iterations = 0;
};

/// min c . x such that A x = b, x >= 0, for few rows (a grasp: 6 to some 40) and some hundred
/// columns. Two-phase simplex method with a fresh LU factor in every step and Bland's rule where
/// steps stall, so it ends. Rows and columns should be of order one. Redundant rows are allowed.
/// Source: Dantzig 1963; Bland 1977.
ProgramSolution solve_linear_program(const Eigen::VectorXd& c, const Eigen::MatrixXd& A,
                                     const Eigen::VectorXd& b);

}  // namespace palmar::grasp
