// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/cone_projection.h"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

namespace palmar::grasp {
namespace {

/// Least squares over the columns in `active` alone.
Eigen::VectorXd solve_active(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                             const std::vector<Eigen::Index>& active) {
  Eigen::MatrixXd part(A.rows(), static_cast<Eigen::Index>(active.size()));
  for (std::size_t k = 0; k < active.size(); ++k) {
    part.col(static_cast<Eigen::Index>(k)) = A.col(active[k]);
  }
  return part.colPivHouseholderQr().solve(b);
}

}  // namespace

ConeProjection project_on_cone(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  ConeProjection result;
  result.x = Eigen::VectorXd::Zero(A.cols());
  result.rest = b;
  std::vector<Eigen::Index> active;
  const double tolerance =
      1e-12 * std::max(1e-300, b.norm()) * std::max(1e-300, A.colwise().norm().maxCoeff());
  const Eigen::Index most = 30 * (A.cols() + 1);
  for (Eigen::Index round = 0; round < most; ++round) {
    const Eigen::VectorXd gain = A.transpose() * result.rest;
    Eigen::Index entering = -1;
    for (Eigen::Index j = 0; j < gain.size(); ++j) {
      if (std::find(active.begin(), active.end(), j) != active.end()) continue;
      if (gain[j] > tolerance && (entering < 0 || gain[j] > gain[entering])) entering = j;
    }
    if (entering < 0) {
      result.has_converged = true;
      break;
    }
    active.push_back(entering);
    Eigen::VectorXd wanted = solve_active(A, b, active);
    while (wanted.size() > 0 && wanted.minCoeff() <= 0.0) {
      // As far towards the solution as all stay above 0; those at 0 leave.
      double step = 1.0;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double from = result.x[active[k]], to = wanted[static_cast<Eigen::Index>(k)];
        if (to <= 0.0) step = std::min(step, from > 0.0 ? from / (from - to) : 0.0);
      }
      std::vector<Eigen::Index> kept;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double to = wanted[static_cast<Eigen::Index>(k)];
        double& x = result.x[active[k]];
        x += step * (to - x);
        if (x > 1e-14 || (to > 0.0 && step == 0.0 && x > 0.0)) {
          kept.push_back(active[k]);
        } else {
          x = 0.0;
        }
      }
      active = std::move(kept);
      wanted = active.empty() ? Eigen::VectorXd() : solve_active(A, b, active);
    }
    for (std::size_t k = 0; k < active.size(); ++k) {
      result.x[active[k]] = wanted[static_cast<Eigen::Index>(k)];
    }
    const Eigen::VectorXd rest = b - A * result.x;
    // Rounding can bring the same column back for nothing; no less rest, no more rounds.
    if (!(rest.squaredNorm() < result.rest.squaredNorm() * (1.0 - 1e-15))) {
      result.has_converged = true;
      break;
    }
    result.rest = rest;
  }
  return result;
}

}  // namespace palmar::grasp
