// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/card_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/picture_edges.h"
#include "hands/capture/sheet/sheet_view.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::capture {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr double kEdgeDeviation = 0.3;                       // pixels, of an edge's ends
constexpr double kTiltDeviation = 12.0 * geometry::kDegree;  // rad, of how people hold it
constexpr int kResiduals = 10;

geometry::Rigid3 moved(const geometry::Rigid3& pose, const Vec6& step) {
  const Vec3 turn = step.head<3>();
  const double angle = turn.norm();
  const Quat by(angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity());
  return {(by * pose.rotation).normalized(), by * pose.translation + step.tail<3>()};
}

Vec2 projected(const CardPose& pose, const geometry::Rigid3& camera_from_table, const Vec3& p) {
  const Vec3 q = camera_from_table * p;
  return pose.focal * q.head<2>() / q.z() + pose.centre;
}

std::array<Vec3, 4> card_corners(const CardPose& pose) {
  const double x = 0.5 * pose.width, y = 0.5 * pose.height, z = card_format().thickness;
  return {Vec3(-x, y, z), Vec3(x, y, z), Vec3(x, -y, z), Vec3(-x, -y, z)};
}

/// In deviations: the ends of every edge from that of the model, the tilt.
using Residuals = Eigen::Matrix<double, kResiduals, 1>;
Residuals residuals(const CardPose& pose, const geometry::Rigid3& at,
                    const std::array<Vec2, 4>& corner, const std::array<FittedLine, 4>& edge) {
  Residuals r;
  const auto model = card_corners(pose);
  for (std::size_t e = 0; e < 4; ++e) {
    const Vec2 a = projected(pose, at, model[e]), b = projected(pose, at, model[(e + 1) % 4]);
    const Vec2 along = (b - a).normalized();
    const FittedLine& line = edge[e];
    const auto on_line = [&](const Vec2& p) {
      return Vec2(line.point + (p - line.point).dot(line.direction) * line.direction);
    };
    const Vec2 &from = corner[e], &to = corner[(e + 1) % 4];
    r[static_cast<Eigen::Index>(2 * e)] =
        cross2(along, on_line(0.9 * from + 0.1 * to) - a) / kEdgeDeviation;
    r[static_cast<Eigen::Index>(2 * e + 1)] =
        cross2(along, on_line(0.1 * from + 0.9 * to) - a) / kEdgeDeviation;
  }
  // The table's normal in the camera against the way to the camera.
  const Vec3 normal = at.rotation * Vec3::UnitZ();
  r[8] = normal.x() / kTiltDeviation;
  r[9] = normal.y() / kTiltDeviation;
  return r;
}

/// The pose of least misfit near a first one, with its covariance. Returns the sum of squares.
double refine(CardPose& pose, const std::array<Vec2, 4>& corner,
              const std::array<FittedLine, 4>& edge) {
  const auto about = [&](const geometry::Rigid3& at) {
    return geometry::with_numeric_jacobian(
        [&pose, &corner, &edge, at](const Eigen::VectorXd& step, Eigen::VectorXd& r) {
          r = residuals(pose, moved(at, step), corner, edge);
        },
        [](Eigen::Index j, double) { return j < 3 ? 1e-6 : 1e-3; });
  };
  geometry::LeastSquaresProblem problem;
  problem.evaluate = about(pose.camera_from_table);
  problem.upper = Eigen::VectorXd{{3.0, 3.0, 3.0, 1e4, 1e4, 1e4}};  // rad, mm
  problem.lower = -problem.upper;
  const geometry::LeastSquaresSolution found = geometry::solve_least_squares(
      problem, Eigen::VectorXd::Zero(6), {.max_iterations = 100, .step_tolerance = 1e-9});
  pose.camera_from_table = moved(pose.camera_from_table, found.x);
  // Steps from the pose found: those of its covariance.
  Eigen::VectorXd r;
  Eigen::MatrixXd jacobian;
  about(pose.camera_from_table)(Eigen::VectorXd::Zero(6), r, &jacobian);
  pose.misfit = kEdgeDeviation * std::sqrt(r.head<8>().squaredNorm() / 8.0);
  pose.covariance = (jacobian.transpose() * jacobian).inverse();
  return found.sum_of_squares;
}

/// A pose from the corners' homography; `sign` mirrors how it leans.
geometry::Rigid3 first_pose(const CardPose& pose, const std::array<Vec2, 4>& corner, double sign) {
  Eigen::Matrix3d k;
  k << pose.focal, 0.0, pose.centre.x(), 0.0, pose.focal, pose.centre.y(), 0.0, 0.0, 1.0;
  Eigen::Matrix3d h = k.inverse() * homography_of(corner, pose.width, pose.height);
  if (h(2, 2) < 0.0) h = -h;
  h /= 0.5 * (h.col(0).norm() + h.col(1).norm());
  const Vec3 x = Vec3(h(0, 0), h(1, 0), sign * h(2, 0)).normalized();
  Vec3 y = Vec3(h(0, 1), h(1, 1), sign * h(2, 1));
  y = (y - y.dot(x) * x).normalized();
  Eigen::Matrix3d r;
  r.col(0) = x;
  r.col(1) = y;
  r.col(2) = x.cross(y);
  const Quat q(r);
  return {q, h.col(2) - card_format().thickness * r.col(2)};
}

}  // namespace

Eigen::Matrix3d CardPose::pixel_from_table() const {
  Eigen::Matrix3d k;
  k << focal, 0.0, centre.x(), 0.0, focal, centre.y(), 0.0, 0.0, 1.0;
  const Eigen::Matrix3d r = camera_from_table.rotation.toRotationMatrix();
  Eigen::Matrix3d m;
  m.col(0) = r.col(0);
  m.col(1) = r.col(1);
  m.col(2) = camera_from_table.translation;
  return k * m;
}

CardPose CardPose::turned(int quarters) const {
  CardPose result = *this;
  const Quat by(Eigen::AngleAxisd(0.5 * std::numbers::pi * quarters, Vec3::UnitZ()));
  result.camera_from_table.rotation = camera_from_table.rotation * by;
  if (quarters % 2 != 0) std::swap(result.width, result.height);
  return result;
}

double CardPose::scale_error(const Vec2& a, const Vec2& b) const {
  const Eigen::Matrix3d now = pixel_from_table();
  const Vec2 seen_a = (now * a.homogeneous()).hnormalized(),
             seen_b = (now * b.homogeneous()).hnormalized();
  const auto length = [&](const geometry::Rigid3& at) {
    CardPose other = *this;
    other.camera_from_table = at;
    const Eigen::Matrix3d table = other.pixel_from_table().inverse();
    return ((table * seen_a.homogeneous()).hnormalized() -
            (table * seen_b.homogeneous()).hnormalized())
        .norm();
  };
  Vec6 slope;
  for (int k = 0; k < 6; ++k) {
    const double step = k < 3 ? 1e-5 : 1e-2;
    Vec6 by = Vec6::Zero();
    by[k] = step;
    slope[k] = (length(moved(camera_from_table, by)) - length(moved(camera_from_table, -by))) /
               (2.0 * step);
  }
  return std::sqrt(std::max(0.0, slope.dot(covariance * slope))) / (b - a).norm();
}

CardPose fit_card(const std::array<Vec2, 4>& corner, const std::array<FittedLine, 4>& edge,
                  double focal, const Vec2& centre) {
  CardPose best;
  double least = std::numeric_limits<double>::infinity();
  // Its long side along either pair of edges; leaning one way or the other.
  for (std::size_t first : {std::size_t{0}, std::size_t{1}}) {
    std::array<Vec2, 4> corners{};
    std::array<FittedLine, 4> edges;
    for (std::size_t e = 0; e < 4; ++e) {
      corners[e] = corner[(e + first) % 4];
      edges[e] = edge[(e + first) % 4];
    }
    for (const double sign : {1.0, -1.0}) {
      CardPose pose;
      pose.width = card_format().width;
      pose.height = card_format().height;
      pose.focal = focal;
      pose.centre = centre;
      pose.camera_from_table = first_pose(pose, corners, sign);
      const double sum = refine(pose, corners, edges);
      if (!(sum < least)) continue;
      least = sum;
      best = pose;
    }
  }
  return best;
}

}  // namespace palmar::capture
