// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/lens_calibration.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/geometry/rotation.h"

namespace palmar::capture {
namespace {

using Corners = std::vector<BoardCorner>;

constexpr std::size_t kFewestCorners = 8;
constexpr int kLensSize = 6;  // f_x, f_y, c_x, c_y, k1, k2

/// The homography from the board's plane to points, by normalised linear equations (Hartley,
/// Zisserman 2004, 4.4); nothing if the points lie on a line.
std::optional<Eigen::Matrix3d> homography(const Corners& corners, const std::vector<Vec2>& to) {
  const auto normaliser = [](const std::vector<Vec2>& points) {
    Vec2 mean = Vec2::Zero();
    for (const Vec2& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double size = 0.0;
    for (const Vec2& p : points) size += (p - mean).norm();
    const double scale =
        std::sqrt(2.0) * static_cast<double>(points.size()) / std::max(size, 1e-12);
    Eigen::Matrix3d t;
    t << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
    return t;
  };
  std::vector<Vec2> from;
  for (const BoardCorner& corner : corners) from.push_back(corner.world.head<2>());
  const Eigen::Matrix3d a = normaliser(from), b = normaliser(to);
  Eigen::MatrixXd rows(2 * static_cast<long>(from.size()), 9);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 p = a * from[i].homogeneous();
    const Vec3 q = b * to[i].homogeneous();
    const auto r = 2 * static_cast<long>(i);
    rows.row(r) << p.transpose(), Eigen::RowVector3d::Zero(), -q.x() * p.transpose();
    rows.row(r + 1) << Eigen::RowVector3d::Zero(), p.transpose(), -q.y() * p.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rows.transpose() * rows);
  if (solver.eigenvalues()[1] < 1e-9 * solver.eigenvalues()[8]) return {};
  const Eigen::VectorXd h = solver.eigenvectors().col(0);
  Eigen::Matrix3d matrix;
  matrix << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  return Eigen::Matrix3d(b.inverse() * matrix * a);
}

std::optional<geometry::Rigid3> first_pose(const PhotoLens& lens, const Corners& corners) {
  std::vector<Vec2> directions;
  for (const BoardCorner& corner : corners) directions.push_back(lens.direction_of(corner.pixel));
  const auto h = homography(corners, directions);
  if (!h) return {};
  Eigen::Matrix3d m = *h / (0.5 * (h->col(0).norm() + h->col(1).norm()));
  if (m(2, 2) < 0.0) m = -m;  // the board lies in front
  Eigen::Matrix3d r;
  r << m.col(0), m.col(1), m.col(0).cross(m.col(1));
  return geometry::Rigid3{Quat(geometry::fit_rotation(r)).normalized(), m.col(2)};
}

/// The lens and the places that make the residuals of corners least; Levenberg-Marquardt, the lens
/// free or not, normal equations with the places taken out one by one.
class Adjustment {
 public:
  PhotoLens lens;
  std::vector<geometry::Rigid3> poses;
  std::vector<Corners> corners;  ///< per pose
  bool lens_is_free = false;
  Eigen::MatrixXd lens_information;  ///< of the last solve, 6 x 6
  using LensVector = Eigen::Matrix<double, kLensSize, 1>;
  LensVector expected = LensVector::Zero();  ///< what the lens is like without photographs,
  Eigen::Matrix<double, kLensSize, kLensSize> certainty =
      Eigen::Matrix<double, kLensSize, kLensSize>::Zero();  ///< and how surely, 1 / pixels^2

  /// Residuals of a view and their derivatives by lens (6) and place (3 turn, 3 shift).
  void view(std::size_t v, Eigen::VectorXd& r, Eigen::MatrixXd* by_lens,
            Eigen::MatrixXd* by_pose) const {
    const auto n = static_cast<long>(corners[v].size());
    r.resize(2 * n);
    if (by_lens != nullptr) by_lens->resize(2 * n, kLensSize);
    if (by_pose != nullptr) by_pose->resize(2 * n, 6);
    const geometry::Rigid3& pose = poses[v];
    for (long i = 0; i < n; ++i) {
      const BoardCorner& corner = corners[v][i];
      const Vec3 turned = pose.rotation * corner.world;
      const Vec3 p = turned + pose.translation;
      const Vec2 d = p.head<2>() / p.z();
      const double r2 = d.squaredNorm();
      const double bend = 1.0 + r2 * (lens.k1 + r2 * lens.k2);
      r.segment<2>(2 * i) = lens.pixel_of(d) - corner.pixel;
      if (by_lens == nullptr) continue;
      by_lens->row(2 * i) << bend * d.x(), 0, 1, 0, lens.focal_x * d.x() * r2,
          lens.focal_x * d.x() * r2 * r2;
      by_lens->row(2 * i + 1) << 0, bend * d.y(), 0, 1, lens.focal_y * d.y() * r2,
          lens.focal_y * d.y() * r2 * r2;
      const double slope = 2.0 * (lens.k1 + 2.0 * r2 * lens.k2);
      Eigen::Matrix2d by_direction = bend * Eigen::Matrix2d::Identity() + slope * d * d.transpose();
      by_direction.row(0) *= lens.focal_x;
      by_direction.row(1) *= lens.focal_y;
      Eigen::Matrix<double, 2, 3> by_point;
      by_point << 1, 0, -d.x(), 0, 1, -d.y();
      by_point = by_direction * by_point / p.z();
      Eigen::Matrix3d cross;
      cross << 0, -turned.z(), turned.y(), turned.z(), 0, -turned.x(), -turned.y(), turned.x(), 0;
      by_pose->block<2, 3>(2 * i, 0) = -by_point * cross;
      by_pose->block<2, 3>(2 * i, 3) = by_point;
    }
  }

  double residuals() const {
    double sum = 0.0;
    Eigen::VectorXd r;
    for (std::size_t v = 0; v < poses.size(); ++v) {
      view(v, r, nullptr, nullptr);
      sum += r.squaredNorm();
    }
    return sum;
  }
  double cost() const {
    const LensVector off = numbers() - expected;
    return residuals() + off.dot(certainty * off);
  }

  LensVector numbers() const {
    LensVector all;
    all << lens.focal_x, lens.focal_y, lens.centre_x, lens.centre_y, lens.k1, lens.k2;
    return all;
  }

  /// Beside residuals of a tenth of a pixel.
  void expect(const LensExpectation& what, double focal) {
    constexpr double kNoise = 0.1;  // pixels
    const auto weight = [](double deviation) { return std::pow(kNoise / deviation, 2); };
    expected << focal, focal, lens.centre_x, lens.centre_y, 0.0, 0.0;
    certainty.setZero();
    const double size = std::max(lens.width, lens.height);
    certainty(2, 2) = certainty(3, 3) = weight(what.centre_deviation * size);
    if (what.focal) certainty(0, 0) = certainty(1, 1) = 0.5 * weight(what.focal_deviation * focal);
    const double square = weight(what.square_deviation * focal);  // of f_x - f_y
    certainty(0, 0) += square;
    certainty(1, 1) += square;
    certainty(0, 1) -= square;
    certainty(1, 0) -= square;
  }

  void solve() {
    double damping = 1e-3, sum = cost();
    constexpr int kRounds = 100;
    for (int round = 0; round < kRounds; ++round) {
      Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kLensSize, kLensSize);
      Eigen::VectorXd g = Eigen::VectorXd::Zero(kLensSize);
      struct View {
        Eigen::Matrix<double, 6, 6> pose;
        Eigen::Matrix<double, 6, kLensSize> mixed;
        Eigen::Matrix<double, 6, 1> gradient;
      };
      std::vector<View> views(poses.size());
      Eigen::VectorXd r;
      Eigen::MatrixXd l, p;
      lens_information = certainty;
      a += certainty;
      g += certainty * (numbers() - expected);
      for (std::size_t v = 0; v < poses.size(); ++v) {
        view(v, r, &l, &p);
        View& one = views[v];
        one.pose = p.transpose() * p;
        one.mixed = p.transpose() * l;
        one.gradient = p.transpose() * r;
        lens_information +=
            l.transpose() * l - one.mixed.transpose() * one.pose.ldlt().solve(one.mixed);
        one.pose.diagonal() *= 1.0 + damping;
        const auto factor = one.pose.ldlt();
        Eigen::MatrixXd own = l.transpose() * l;
        own.diagonal() *= 1.0 + damping;
        a += own - one.mixed.transpose() * factor.solve(one.mixed);
        g += l.transpose() * r - one.mixed.transpose() * factor.solve(one.gradient);
      }
      Eigen::VectorXd change = Eigen::VectorXd::Zero(kLensSize);
      if (lens_is_free) change = -a.ldlt().solve(g);
      Adjustment next = *this;
      next.lens.focal_x += change[0];
      next.lens.focal_y += change[1];
      next.lens.centre_x += change[2];
      next.lens.centre_y += change[3];
      next.lens.k1 += change[4];
      next.lens.k2 += change[5];
      for (std::size_t v = 0; v < poses.size(); ++v) {
        const Eigen::Matrix<double, 6, 1> step =
            -views[v].pose.ldlt().solve(views[v].gradient + views[v].mixed * change);
        const Vec3 turn = step.head<3>();
        if (turn.norm() > 0.0) {
          next.poses[v].rotation =
              (Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * poses[v].rotation)
                  .normalized();
        }
        next.poses[v].translation += step.tail<3>();
      }
      const double lower = next.cost();
      if (std::isfinite(lower) && lower <= sum) {
        const bool is_done = sum - lower <= 1e-10 * sum;
        lens = next.lens;
        poses = next.poses;
        sum = lower;
        damping = std::max(1e-12, 0.2 * damping);
        if (is_done) break;
      } else {
        damping *= 5.0;
        if (damping > 1e8) break;
      }
    }
  }

  std::size_t count() const {
    std::size_t n = 0;
    for (const Corners& c : corners) n += c.size();
    return n;
  }
  double rms() const {
    return std::sqrt(residuals() / (2.0 * static_cast<double>(std::max<std::size_t>(1, count()))));
  }

  /// Leaves out corners farther off than `limit`.
  void drop(double limit) {
    Eigen::VectorXd r;
    for (std::size_t v = 0; v < poses.size(); ++v) {
      view(v, r, nullptr, nullptr);
      Corners kept;
      for (std::size_t i = 0; i < corners[v].size(); ++i) {
        if (r.segment<2>(2 * static_cast<long>(i)).norm() <= limit) kept.push_back(corners[v][i]);
      }
      if (kept.size() >= kFewestCorners) corners[v] = std::move(kept);
    }
  }

  /// With what doesn't fit left out step by step; the rms.
  double settle() {
    solve();
    double error = rms();
    for (const double least : {2.0, 1.0}) {
      constexpr double kTimes = 4.0;
      drop(std::max(least, kTimes * error));
      solve();
      error = rms();
    }
    return error;
  }
};

/// f from the homographies of pictures whose middle is the lens' and whose pixels are square:
/// columns h1, h2 are images of perpendicular directions of equal length.
std::optional<double> focal_from(const std::vector<Corners>& photographs, const Vec2& centre) {
  double numerator = 0.0, denominator = 0.0;
  for (const Corners& corners : photographs) {
    std::vector<Vec2> pixels;
    for (const BoardCorner& corner : corners) pixels.push_back(corner.pixel - centre);
    const auto h = homography(corners, pixels);
    if (!h) continue;
    const Vec3 a = h->col(0), b = h->col(1);
    const double scale = 1.0 / (a.norm() * b.norm());
    // x / f^2 + y = 0 for both conditions
    for (const auto& [x, y] : {std::pair(a.head<2>().dot(b.head<2>()), a.z() * b.z()),
                               std::pair(a.head<2>().squaredNorm() - b.head<2>().squaredNorm(),
                                         a.z() * a.z() - b.z() * b.z())}) {
      numerator -= scale * scale * x * y;
      denominator += scale * scale * x * x;
    }
  }
  if (!(denominator > 0.0 && numerator > 0.0)) return {};
  return std::sqrt(denominator / numerator);
}

}  // namespace

std::optional<BoardPose> find_board_pose(const PhotoLens& lens,
                                         const std::vector<BoardCorner>& corners) {
  if (corners.size() < kFewestCorners) return {};
  const auto start = first_pose(lens, corners);
  if (!start) return {};
  Adjustment adjustment;
  adjustment.lens = lens;
  adjustment.poses = {*start};
  adjustment.corners = {corners};
  BoardPose pose;
  pose.rms = adjustment.settle();
  pose.camera_from_world = adjustment.poses[0];
  pose.used = static_cast<int>(adjustment.corners[0].size());
  return pose;
}

LensCalibration calibrate_lens(int width, int height,
                               const std::vector<std::vector<BoardCorner>>& photographs,
                               const std::string& name, const LensExpectation& expected) {
  const Vec2 centre(0.5 * (width - 1), 0.5 * (height - 1));
  std::vector<Corners> seen;
  for (const Corners& corners : photographs) {
    if (corners.size() >= kFewestCorners) seen.push_back(corners);
  }
  if (seen.size() < 3) {
    throw InputError(
        fmt::format("{}: {} of {} photographs show 8 corners of the board or more; at least 3 are "
                    "needed, about "
                    "12 with the board tilted every way are advised",
                    name, seen.size(), photographs.size()));
  }
  const double size = std::max(width, height);
  double focal = expected.focal ? *expected.focal : focal_from(seen, centre).value_or(1.2 * size);
  focal = std::clamp(focal, 0.4 * size, 10.0 * size);
  Adjustment adjustment;
  adjustment.lens = {.width = width,
                     .height = height,
                     .focal_x = focal,
                     .focal_y = focal,
                     .centre_x = centre.x(),
                     .centre_y = centre.y()};
  for (const Corners& corners : seen) {
    const auto pose = first_pose(adjustment.lens, corners);
    if (!pose) continue;
    adjustment.poses.push_back(*pose);
    adjustment.corners.push_back(corners);
  }
  adjustment.solve();
  adjustment.lens_is_free = true;
  adjustment.expect(expected, focal);
  LensCalibration result;
  result.rms = adjustment.settle();
  result.lens = adjustment.lens;
  result.photographs = static_cast<int>(adjustment.poses.size());
  constexpr double kWorst = 3.0;  // pixels
  if (!std::isfinite(result.rms) || result.rms > kWorst) {
    throw InputError(
        fmt::format("{}: corners of the board are {:.1f} pixels from where any lens would show "
                    "them; photographs of several lenses or zooms, or another board",
                    name, result.rms));
  }
  result.lens.check(name);
  const Eigen::MatrixXd covariance =
      adjustment.lens_information.ldlt().solve(Eigen::MatrixXd::Identity(kLensSize, kLensSize)) *
      (result.rms * result.rms);
  const auto deviation = [&](int i) { return std::sqrt(std::max(0.0, covariance(i, i))); };
  result.focal_deviation = std::max(deviation(0), deviation(1));
  result.centre_deviation = std::max(deviation(2), deviation(3));
  for (const Corners& corners : photographs) {
    result.poses.push_back(find_board_pose(result.lens, corners));
  }
  return result;
}

}  // namespace palmar::capture
