// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

namespace palmar {

/// Residuals of a fit and, if asked for, their Jacobian, as LeastSquaresProblem wants them: central
/// differences with a step of 1e-5 (rad or mm), good to about 1e-10 of the residuals' scale.
inline void residual_and_jacobian(
    const std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&)>& residual,
    const Eigen::VectorXd& at, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
  constexpr double kStep = 1e-5;
  residual(at, r);
  if (jacobian == nullptr) return;
  jacobian->resize(r.size(), at.size());
  Eigen::VectorXd ahead, behind, x = at;
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    x[j] = at[j] + kStep;
    residual(x, ahead);
    x[j] = x[j] - 2.0 * kStep;
    residual(x, behind);
    jacobian->col(j) = (ahead - behind) / (2.0 * kStep);
    x[j] = at[j];
  }
}

}  // namespace palmar
