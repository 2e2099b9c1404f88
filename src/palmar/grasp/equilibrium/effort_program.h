// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palmar::grasp {

/// Least effort of muscles that move a hand a little: with activations a, a motion x and what is
/// missing s,
///
///     min  sum a_i^3 + g.x + 1/2 x.H x + sum_k price_k |s_k|
///     so that   B a + D x + s = b,   0 <= a <= 1.
///
/// Convex; the prices are an exact penalty: s is 0 wherever some motion and activations can give b,
/// unless that costs more than it is worth.
struct EffortProgram {
  Eigen::MatrixXd muscles;   ///< B, rows x muscles: what a muscle gives at full activation
  Eigen::MatrixXd motion;    ///< D, rows x coordinates; may have none
  Eigen::VectorXd required;  ///< b
  Eigen::VectorXd price;     ///< per unit of s, above 0
  Eigen::MatrixXd hessian;   ///< H, positive definite
  Eigen::VectorXd gradient;  ///< g
};

struct EffortSolution {
  bool has_converged = false;
  Eigen::VectorXd activation, motion, missing;
  /// By how much the value changes with b.
  Eigen::VectorXd multiplier;
  double value = 0.0;
  int iterations = 0;
};

/// Primal-dual interior point method with Mehrotra's predictor and corrector (Nocedal & Wright
/// 2006, section 16.6). Deterministic.
EffortSolution solve_effort(const EffortProgram& program);

}  // namespace palmar::grasp
