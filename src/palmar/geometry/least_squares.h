// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace palmar::geometry {

/// Find x in a box that makes the sum of squares of r(x) least.
struct LeastSquaresProblem {
  /// Fills r (same size at every x) and, unless null, its Jacobian dr/dx.
  std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian)>
      evaluate;
  Eigen::VectorXd lower, upper;  ///< bounds of x; lower < upper
};

struct LeastSquaresOptions {
  int max_iterations = 200;
  /// Converged when no free column of the Jacobian stands to the residual at an angle whose cosine
  /// is more than this.
  double gradient_tolerance = 1e-9;
  double step_tolerance = 1e-11;  ///< of a step, relative to each variable
  void check() const;             ///< throws UsageError: field, value, allowed range
};

enum class LeastSquaresStatus {
  kConverged,       ///< the gradient vanishes on the free variables, or every residual does
  kSmallStep,       ///< no lower sum within a step that counts: a minimum at a kink, or noise
  kIterationLimit,  ///< not converged
  kBadStart         ///< residuals at the start are not finite
};

struct LeastSquaresSolution {
  LeastSquaresStatus status = LeastSquaresStatus::kBadStart;
  Eigen::VectorXd x;
  Eigen::VectorXd residual;    ///< r(x)
  Eigen::MatrixXd jacobian;    ///< at x
  std::vector<char> at_bound;  ///< per variable: x stands on a bound and would go beyond it
  double sum_of_squares = 0.0;
  int iterations = 0;
};

/// Levenberg-Marquardt with the damping of Nielsen 1999 (IMM-REP-1999-05) and Marquardt's scaling;
/// variables that would leave the box stay on its wall while the gradient holds them there, steps
/// are cut at the wall. `start` is brought into the box. Not converging is a status, never an
/// exception; throws UsageError on sizes that don't match.
LeastSquaresSolution solve_least_squares(const LeastSquaresProblem& problem,
                                         const Eigen::VectorXd& start,
                                         const LeastSquaresOptions& options = {});

}  // namespace palmar::geometry
