// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/two_axis_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hands/capture/axis_fit.h"
#include "palmar/core/error.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::capture {
namespace {

/// One axis near its prior: x tilts it by two angles and shifts it across by two lengths.
struct AxisFrame {
  Vec3 axis, point, e1, e2;

  AxisFrame(const Vec3& direction, const Vec3& near)
      : axis(direction.normalized()), point(near), e1(axis.unitOrthogonal()), e2(axis.cross(e1)) {}
  Vec3 axis_at(const Eigen::Vector4d& x) const {
    return (axis + x[0] * e1 + x[1] * e2).normalized();
  }
  Vec3 point_at(const Eigen::Vector4d& x) const { return point + x[2] * e1 + x[3] * e2; }
};

/// Angles about two axes whose sum comes nearest to the rotation vector of a motion.
Eigen::Vector2d angles_near(const geometry::Rigid3& motion, const Vec3& first, const Vec3& second) {
  const AxisFit turn = fit_axis(motion, Vec3::Zero());
  Eigen::Matrix<double, 3, 2> axes;
  axes << first, second;
  const Vec3 wanted = turn.angle * turn.axis;
  return axes.colPivHouseholderQr().solve(wanted);
}

}  // namespace

TwoAxisFit fit_two_axes(std::span<const geometry::Rigid3> motions, std::span<const MainAxis> main,
                        std::span<const Vec3> points, const TwoAxisPrior& prior) {
  if (motions.empty() || points.empty() || main.size() != motions.size()) {
    throw UsageError(
        "joint with two axes: no motions, no points to move, or not as many main axes");
  }
  const AxisFrame first(prior.first, prior.near), second(prior.second, prior.near);
  const auto count = static_cast<Eigen::Index>(motions.size());
  const Eigen::Index slides = 8 + 2 * count;
  const Eigen::Index n = slides + 2 * count;  // the axes; angles of each motion; its slides
  const auto per_motion = static_cast<Eigen::Index>(points.size()) * 3;
  const auto screw = [](const Vec3& axis, const Vec3& point, double angle, double slide) {
    geometry::Rigid3 motion = geometry::Rigid3::about_axis(axis, point, angle);
    motion.translation += slide * axis;
    return motion;
  };
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    r.resize(per_motion * count + 9 + 4 * count);
    const Eigen::Vector4d a = x.head<4>(), b = x.segment<4>(4);
    for (Eigen::Index k = 0; k < count; ++k) {
      const geometry::Rigid3 turn =
          screw(first.axis_at(a), first.point_at(a), x[8 + 2 * k], x[slides + 2 * k]) *
          screw(second.axis_at(b), second.point_at(b), x[9 + 2 * k], x[slides + 1 + 2 * k]);
      const geometry::Rigid3& motion = motions[k];
      for (std::size_t i = 0; i < points.size(); ++i) {
        r.segment<3>(per_motion * k + 3 * static_cast<Eigen::Index>(i)) =
            (turn * points[i] - motion * points[i]) / prior.point_sd;
      }
    }
    const Eigen::Index p = per_motion * count;
    r.segment<2>(p) = a.head<2>() / prior.first_sd;
    r.segment<2>(p + 2) = a.tail<2>() / prior.place_sd;
    r.segment<2>(p + 4) = b.head<2>() / prior.second_sd;
    r.segment<2>(p + 6) = b.tail<2>() / prior.place_sd;
    r.tail(2 * count) = x.tail(2 * count) / prior.slide_sd;
    r[p + 8] = first.axis_at(a).dot(second.axis_at(b)) / prior.square_sd;
    for (Eigen::Index k = 0; k < count; ++k) {
      const MainAxis m = main[k];
      // Free angles are held by next to nothing, so that none is left undetermined.
      constexpr double kFree = 10.0;  // rad
      r[p + 9 + 2 * k] = x[8 + 2 * k] / (m == MainAxis::kSecond ? prior.by_second_sd : kFree);
      r[p + 10 + 2 * k] = x[9 + 2 * k] / (m == MainAxis::kFirst ? prior.by_first_sd : kFree);
    }
  };
  geometry::LeastSquaresProblem problem;
  problem.evaluate = geometry::with_numeric_jacobian(residual);
  problem.lower = Eigen::VectorXd::Constant(n, -std::numbers::pi);
  problem.upper = -problem.lower;
  for (const Eigen::Index j : {2, 6}) {
    problem.lower.segment<2>(j).setConstant(-50.0);  // mm
    problem.upper.segment<2>(j).setConstant(50.0);
  }
  problem.lower.tail(2 * count).setConstant(-50.0);
  problem.upper.tail(2 * count).setConstant(50.0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < count; ++k) {
    x.segment<2>(8 + 2 * k) = angles_near(motions[k], first.axis, second.axis);
  }
  const geometry::LeastSquaresSolution solution = geometry::solve_least_squares(
      problem, x, {.gradient_tolerance = 1e-8, .step_tolerance = 1e-10});
  x = solution.x;

  TwoAxisFit fit;
  const Eigen::MatrixXd covariance = (solution.jacobian.transpose() * solution.jacobian)
                                         .ldlt()
                                         .solve(Eigen::MatrixXd::Identity(n, n));
  fit.first_error = std::sqrt(0.5 * covariance.topLeftCorner<2, 2>().trace());
  fit.second_error = std::sqrt(0.5 * covariance.block<2, 2>(4, 4).trace());
  const Eigen::Vector4d a = x.head<4>(), b = x.segment<4>(4);
  fit.first_axis = first.axis_at(a);
  fit.first_point = first.point_at(a);
  fit.second_axis = second.axis_at(b);
  fit.second_point = second.point_at(b);
  for (Eigen::Index k = 0; k < count; ++k) {
    fit.angle.push_back({x[8 + 2 * k], x[9 + 2 * k]});
    fit.is_first_observed = fit.is_first_observed || std::abs(x[8 + 2 * k]) >= kLeastTurn;
    fit.is_second_observed = fit.is_second_observed || std::abs(x[9 + 2 * k]) >= kLeastTurn;
  }
  x.tail(2 * count).setZero();
  Eigen::VectorXd r;
  residual(x, r);
  const Eigen::Index m = per_motion * count;
  fit.rms = prior.point_sd * std::sqrt(3.0 * r.head(m).squaredNorm() / static_cast<double>(m));
  return fit;
}

}  // namespace palmar::capture
