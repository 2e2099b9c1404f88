// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palmar::grasp {

/// Nearest point to b of the cone of all combinations of the columns of A with factors x >= 0.
struct ConeProjection {
  Eigen::VectorXd x;
  /// b - A x: no column has a component along it (A^T rest <= 0), and b . rest = |rest|^2. 0 if b
  /// lies in the cone; unique, and turns with A and b.
  Eigen::VectorXd rest;
  bool has_converged = false;
};

/// Least squares with x >= 0 for few rows and some hundred columns. Source: Lawson, Hanson 1974,
/// chapter 23.
ConeProjection project_on_cone(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace palmar::grasp
