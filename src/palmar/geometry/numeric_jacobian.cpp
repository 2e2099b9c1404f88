// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/numeric_jacobian.h"

#include <utility>

namespace palmar::geometry {

std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian)>
with_numeric_jacobian(std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r)> residual,
                      std::function<double(Eigen::Index j, double x_j)> step) {
  return [residual = std::move(residual), step = std::move(step)](
             const Eigen::VectorXd& at, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    residual(at, r);
    if (jacobian == nullptr) return;
    jacobian->resize(r.size(), at.size());
    Eigen::VectorXd ahead, behind, x = at;
    for (Eigen::Index j = 0; j < at.size(); ++j) {
      const double h = step ? step(j, at[j]) : 1e-5;
      x[j] = at[j] + h;
      residual(x, ahead);
      x[j] = x[j] - 2.0 * h;
      residual(x, behind);
      jacobian->col(j) = (ahead - behind) / (2.0 * h);
      x[j] = at[j];
    }
  };
}

}  // namespace palmar::geometry
