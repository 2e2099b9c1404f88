// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/dotted_joints.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/core/error.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::capture {

double noise_of_dots(std::span<const DotGroup> groups) {
  double squares = 0.0, freedom = 0.0;
  for (const DotGroup& group : groups) {
    constexpr std::size_t kFewest = 3;  // two dots keep their distance only
    if (group.before.size() < kFewest) continue;
    const geometry::Rigid3 moved = align_points(group.before, group.after);
    for (std::size_t i = 0; i < group.before.size(); ++i) {
      squares += (moved * group.before[i] - group.after[i]).squaredNorm();
    }
    freedom += 3.0 * static_cast<double>(group.before.size()) - 6.0;
  }
  constexpr double kLeast = 0.5, kMost = 1.5, kUsual = 1.0, kUsualSamples = 6.0;  // mm
  const double variance = (kUsualSamples * kUsual * kUsual + squares) / (kUsualSamples + freedom);
  return std::clamp(std::sqrt(variance), kLeast, kMost);
}

namespace {

/// Two tilts of the axis and two shifts of the point, across the axis, and the turn.
class DotProblem {
 public:
  DotProblem(std::span<const Vec3> before, std::span<const Vec3> after, const HingePrior& prior)
      : before_(before), after_(after), prior_(prior), a_(prior.axis.unitOrthogonal()) {
    b_ = prior.axis.cross(a_);
  }
  DotHinge hinge(const Eigen::VectorXd& x) const {
    DotHinge h;
    h.axis = (prior_.axis + x[0] * a_ + x[1] * b_).normalized();
    h.point = prior_.point + x[2] * a_ + x[3] * b_;
    h.turn = x[4];
    return h;
  }
  geometry::LeastSquaresSolution solve(double dot_sd, double axis_sd) const {
    const auto residual = [this, dot_sd, axis_sd](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
      const DotHinge h = hinge(x);
      const geometry::Rigid3 turn = geometry::Rigid3::about_axis(h.axis, h.point, h.turn);
      r.resize(static_cast<Eigen::Index>(3 * before_.size() + 4));
      for (std::size_t i = 0; i < before_.size(); ++i) {
        r.segment<3>(static_cast<Eigen::Index>(3 * i)) = (turn * before_[i] - after_[i]) / dot_sd;
      }
      r.tail<4>() << x[0] / axis_sd, x[1] / axis_sd, x[2] / prior_.point_sd, x[3] / prior_.point_sd;
    };
    geometry::LeastSquaresProblem problem;
    problem.lower = Eigen::VectorXd::Constant(5, -20.0);
    problem.upper = Eigen::VectorXd::Constant(5, 20.0);
    problem.lower.head<2>().setConstant(-1.0);
    problem.upper.head<2>().setConstant(1.0);
    problem.lower[4] = -std::numbers::pi;
    problem.upper[4] = std::numbers::pi;
    problem.evaluate = geometry::with_numeric_jacobian(residual);
    Eigen::VectorXd start = Eigen::VectorXd::Zero(5);
    start[4] = prior_.turn;
    return geometry::solve_least_squares(problem, start, {.max_iterations = 60});
  }
  /// Sum of the dots' squared distances, mm^2.
  double left_over(const geometry::LeastSquaresSolution& found, double dot_sd) const {
    return dot_sd * dot_sd * found.residual.head(found.residual.size() - 4).squaredNorm();
  }

 private:
  std::span<const Vec3> before_, after_;
  const HingePrior& prior_;
  Vec3 a_, b_;
};

/// Covariance of the two tilts.
Eigen::Matrix2d tilt_covariance(const geometry::LeastSquaresSolution& found) {
  const Eigen::MatrixXd normal = found.jacobian.transpose() * found.jacobian;
  return normal.ldlt().solve(Eigen::MatrixXd::Identity(5, 5)).topLeftCorner<2, 2>();
}

double error_of(const Eigen::Matrix2d& covariance) { return std::sqrt(0.5 * covariance.trace()); }

}  // namespace

DotHinge fit_dot_hinge(std::span<const Vec3> before, std::span<const Vec3> after,
                       const HingePrior& prior) {
  if (before.size() != after.size() || before.empty()) {
    throw UsageError("hinge by dots: as many dots after as before are required, one at least");
  }
  const DotProblem problem(before, after, prior);
  // The axis open; its tilts stay below 45 degrees.
  constexpr double kOpen = 10.0;  // rad
  constexpr double kPriorSamples = 8.0, kUnknowns = 5.0;
  constexpr double kBeyond95 = 5.991;  // of chi squared with two degrees of freedom
  const geometry::LeastSquaresSolution first = problem.solve(prior.dot_sd, kOpen);
  const double freedom = std::max(0.0, 3.0 * static_cast<double>(before.size()) - kUnknowns);
  const double variance =
      (kPriorSamples * prior.dot_sd * prior.dot_sd + problem.left_over(first, prior.dot_sd)) /
      (kPriorSamples + freedom);
  const double dot_sd = std::sqrt(variance);
  const geometry::LeastSquaresSolution alone = problem.solve(dot_sd, kOpen);
  const Eigen::Matrix2d by_dots = tilt_covariance(alone);
  const Eigen::Vector2d tilt = alone.x.head<2>();
  const Eigen::Matrix2d both =
      by_dots + prior.axis_sd * prior.axis_sd * Eigen::Matrix2d::Identity();
  const bool is_conflict = tilt.dot(both.ldlt().solve(tilt)) > kBeyond95;
  const bool is_alone = is_conflict && error_of(by_dots) < prior.axis_sd;
  const geometry::LeastSquaresSolution found =
      is_alone ? alone : problem.solve(dot_sd, prior.axis_sd);
  DotHinge best = problem.hinge(found.x);
  best.residual = std::sqrt(problem.left_over(found, dot_sd) / static_cast<double>(before.size()));
  best.axis_error = error_of(tilt_covariance(found));
  best.dots_error = error_of(by_dots);
  best.dots_tilt = std::acos(std::min(1.0, problem.hinge(alone.x).axis.dot(prior.axis)));
  best.is_conflict = is_conflict;
  return best;
}

}  // namespace palmar::capture
