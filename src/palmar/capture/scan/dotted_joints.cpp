// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/scan/dotted_joints.h"

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar {

DotHinge fit_dot_hinge(std::span<const Vec3> before, std::span<const Vec3> after,
                       const HingePrior& prior) {
  if (before.size() != after.size() || before.empty()) {
    throw UsageError("hinge by dots: as many dots after as before are required, one at least");
  }
  // Two tilts of the axis and two shifts of the point, across the axis, and the turn.
  const Vec3 a = prior.axis.unitOrthogonal(), b = prior.axis.cross(a);
  const auto hinge = [&](const Eigen::VectorXd& x) {
    DotHinge h;
    h.axis = (prior.axis + x[0] * a + x[1] * b).normalized();
    h.point = prior.point + x[2] * a + x[3] * b;
    h.turn = x[4];
    return h;
  };
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    const DotHinge h = hinge(x);
    const Rigid3 turn = Rigid3::about_axis(h.axis, h.point, h.turn);
    r.resize(static_cast<Eigen::Index>(3 * before.size() + 4));
    for (std::size_t i = 0; i < before.size(); ++i) {
      r.segment<3>(static_cast<Eigen::Index>(3 * i)) = (turn * before[i] - after[i]) / prior.dot_sd;
    }
    r.tail<4>() << x[0] / prior.axis_sd, x[1] / prior.axis_sd, x[2] / prior.point_sd,
        x[3] / prior.point_sd;
  };
  LeastSquaresProblem problem;
  problem.lower = Eigen::VectorXd::Constant(5, -20.0);
  problem.upper = Eigen::VectorXd::Constant(5, 20.0);
  problem.lower.head<2>().setConstant(-1.0);
  problem.upper.head<2>().setConstant(1.0);
  problem.lower[4] = -std::numbers::pi;
  problem.upper[4] = std::numbers::pi;
  problem.evaluate = with_numeric_jacobian(residual);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(5);
  start[4] = prior.turn;
  const LeastSquaresSolution found = solve_least_squares(problem, start, {.max_iterations = 60});
  DotHinge best = hinge(found.x);
  const double dots = found.residual.head(found.residual.size() - 4).squaredNorm();
  best.residual = prior.dot_sd * std::sqrt(dots / static_cast<double>(before.size()));
  return best;
}

}  // namespace palmar
