// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <Eigen/Core>

namespace palmar::geometry {

/// Residuals without derivatives as LeastSquaresProblem::evaluate: fills r(x) and, if asked for,
/// its Jacobian by central differences
///
///     dr/dx_j = (r(x + h_j e_j) - r(x - h_j e_j)) / (2 h_j).
///
/// `step` gives h_j from j and x_j, in the unit of that variable. Unset: 1e-5 (rad, mm), good to
/// about 1e-10 of the residuals' scale.
std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian)>
with_numeric_jacobian(std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r)> residual,
                      std::function<double(Eigen::Index j, double x_j)> step = {});

}  // namespace palmar::geometry
