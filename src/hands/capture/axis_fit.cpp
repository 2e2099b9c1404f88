// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/axis_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::capture {
namespace {

/// Turn of q about the unit vector `axis` alone, (-pi, pi]: q = twist * (turn about an axis square
/// to it).
double twist_about(const Quat& q, const Vec3& axis) {
  return std::remainder(2.0 * std::atan2(q.vec().dot(axis), q.w()), 2.0 * std::numbers::pi);
}

/// Parameters of one axis and its angles: a, b tilt it, c, d shift it across, then the angles.
struct HingeFrame {
  Vec3 axis, point, e1, e2;

  Vec3 axis_at(const Eigen::VectorXd& x) const {
    return (axis + x[0] * e1 + x[1] * e2).normalized();
  }
  Vec3 point_at(const Eigen::VectorXd& x) const { return point + x[2] * e1 + x[3] * e2; }
};

/// HingeFit::axis_error of motions about the axis that was found.
double error_of_axis(std::span<const geometry::Rigid3> motions, const HingeFit& fit) {
  constexpr double kLeastWeight = 1e-12;  // of a motion without any turn
  double weights = kLeastWeight, spread = 0.0;
  for (const geometry::Rigid3& motion : motions) {
    const AxisFit own = fit_axis(motion, fit.point);
    const double sine = 2.0 * std::sin(0.5 * own.angle);
    weights += sine * sine;
    const double off =
        std::atan2(own.axis.cross(fit.axis).norm(), std::abs(own.axis.dot(fit.axis)));
    spread += sine * sine * off * off;
  }
  const double known = kTurnError * kTurnError;
  const double degrees = 1.0 + 2.0 * (static_cast<double>(motions.size()) - 1.0);
  const double square = std::max(known, (known + spread) / degrees);
  return std::min(0.5 * std::numbers::pi, std::sqrt(square / weights));
}

}  // namespace

AxisFit fit_axis(const geometry::Rigid3& motion, const Vec3& near) {
  AxisFit fit;
  Quat q = motion.rotation.normalized();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  // Half-angle from sine and cosine both: exact for the smallest angles and near pi, where the
  // trace and the skew part of R fail.
  const double sine = q.vec().norm();
  fit.angle = 2.0 * std::atan2(sine, q.w());
  const Vec3 shift = motion * near - near;
  if (sine == 0.0) {
    // A mere shift: a screw of no turn along it.
    fit.slide = shift.norm();
    if (fit.slide > 0.0) fit.axis = shift / fit.slide;
    fit.point = near;
    return fit;
  }
  fit.axis = q.vec() / sine;
  fit.slide = shift.dot(fit.axis);
  // (E - R) p = t across the axis, solved in closed form: with t as seen from `near`,
  // p = (t + cot(angle / 2) u x t) / 2 is the solution nearest to there.
  const Vec3 across = shift - fit.slide * fit.axis;
  fit.point = near + 0.5 * (across + q.w() / sine * fit.axis.cross(across));
  fit.is_observed = fit.angle >= kLeastTurn;
  return fit;
}

std::array<Vec3, 6> moment_points(const geometry::TriangleMesh& mesh) {
  double area = 0.0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  const Vec3 origin = mesh.vertices.empty() ? Vec3::Zero() : mesh.vertices.front();
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = mesh.vertices[t[k]] - origin;
    }
    const double part = geometry::triangle_area(corner[0], corner[1], corner[2]);
    const Vec3 sum = corner[0] + corner[1] + corner[2];
    Eigen::Matrix3d outer = sum * sum.transpose();
    for (const Vec3& c : corner) outer += c * c.transpose();
    area += part;
    first += part / 3.0 * sum;
    second += part / 12.0 * outer;
  }
  if (!(area > 0.0)) throw InputError("moments of a surface: it has no area");
  const Vec3 centre = first / area;
  const Eigen::Matrix3d spread = second / area - centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  std::array<Vec3, 6> points;
  for (int k = 0; k < 3; ++k) {
    const double reach = std::sqrt(3.0 * std::max(0.0, solver.eigenvalues()[k]));
    const Vec3 step = reach * solver.eigenvectors().col(k);
    points[2 * k] = origin + centre + step;
    points[2 * k + 1] = origin + centre - step;
  }
  return points;
}

HingeFit fit_hinge(std::span<const geometry::Rigid3> motions, std::span<const Vec3> points,
                   const Vec3& near) {
  if (motions.empty() || points.empty()) {
    throw UsageError("joint axis: no motions or no points to move; at least one is required");
  }
  AxisFit start;
  for (const geometry::Rigid3& motion : motions) {
    const AxisFit fit = fit_axis(motion, near);
    if (fit.angle > start.angle) start = fit;
  }
  HingeFit fit;
  if (start.angle == 0.0) {  // nothing turns: any axis does
    fit.point = near;
    fit.angle.assign(motions.size(), 0.0);
    fit.slide.assign(motions.size(), 0.0);
    return fit;
  }
  HingeFrame frame{start.axis, start.point, start.axis.unitOrthogonal(), Vec3::Zero()};
  frame.e2 = frame.axis.cross(frame.e1);

  const auto count = static_cast<Eigen::Index>(motions.size());
  const Eigen::Index n = 4 + 2 * count;  // tilt, shift; angles; slides
  const auto rows = static_cast<Eigen::Index>(points.size()) * 3;
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    constexpr double kSlideWeight = 0.05;  // registration errs by 0.15 mm, bones slide by 3 mm
    r.resize((rows + 1) * count);
    for (Eigen::Index k = 0; k < count; ++k) {
      geometry::Rigid3 turn =
          geometry::Rigid3::about_axis(frame.axis_at(x), frame.point_at(x), x[4 + k]);
      turn.translation += x[4 + count + k] * frame.axis_at(x);
      r[rows * count + k] = kSlideWeight * x[4 + count + k];
      const geometry::Rigid3& motion = motions[k];
      for (std::size_t i = 0; i < points.size(); ++i) {
        r.segment<3>(rows * k + 3 * static_cast<Eigen::Index>(i)) =
            turn * points[i] - motion * points[i];
      }
    }
  };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < count; ++k) {
    const geometry::Rigid3& motion = motions[k];
    x[4 + k] = twist_about(motion.rotation, frame.axis);
    x[4 + count + k] = (motion * near - near).dot(frame.axis);
  }
  if (count > 1) {
    geometry::LeastSquaresProblem problem;
    problem.evaluate = geometry::with_numeric_jacobian(residual);
    problem.lower = Eigen::VectorXd::Constant(n, -2.0 * std::numbers::pi);
    problem.upper = -problem.lower;
    problem.lower.segment<2>(2).setConstant(-100.0);  // mm
    problem.upper.segment<2>(2).setConstant(100.0);
    problem.lower.tail(count).setConstant(-100.0);
    problem.upper.tail(count).setConstant(100.0);
    x = geometry::solve_least_squares(problem, x).x;
  }
  fit.axis = frame.axis_at(x);
  fit.point = frame.point_at(x);
  fit.point += (near - fit.point).dot(fit.axis) * fit.axis;
  for (Eigen::Index k = 0; k < count; ++k) {
    fit.angle.push_back(x[4 + k]);
    fit.slide.push_back(x[4 + count + k]);
  }
  fit.axis_error = error_of_axis(motions, fit);
  x.tail(count).setZero();
  Eigen::VectorXd r;
  residual(x, r);
  fit.rms = std::sqrt(3.0 * r.squaredNorm() / static_cast<double>(rows * count));
  fit.is_observed = start.is_observed;
  return fit;
}

}  // namespace palmar::capture
