// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/surface_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"

namespace palmar::redesign {
namespace {

constexpr std::array<product::FaceKind, 5> kKinds = {
    product::FaceKind::kPlane, product::FaceKind::kCylinder, product::FaceKind::kSphere,
    product::FaceKind::kCone, product::FaceKind::kTorus};
constexpr std::size_t kPointsOfAStart = 400;  // suffice to distinguish good starts from bad ones

int parameters_of(product::FaceKind kind) {
  switch (kind) {
    case product::FaceKind::kPlane:
      return 3;
    case product::FaceKind::kSphere:
      return 4;
    case product::FaceKind::kCylinder:
      return 5;
    case product::FaceKind::kCone:
      return 6;
    case product::FaceKind::kTorus:
      return 7;
    case product::FaceKind::kFreeform:
      break;
  }
  throw UsageError("surface fit: freeform; plane, cylinder, cone, sphere, torus are possible");
}

/// Two unit vectors that stand on `axis` and each other.
std::array<Vec3, 2> across(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

/// The surface near `start` that parameters x stand for: shifts, turns of the axis, radii.
SimpleSurface moved(const SimpleSurface& start, const Eigen::VectorXd& x) {
  SimpleSurface result = start;
  const auto [e1, e2] = across(start.axis);
  if (start.kind == product::FaceKind::kSphere) {
    result.point += x.head<3>();
    result.radius = x[3];
    return result;
  }
  result.axis = (start.axis + x[0] * e1 + x[1] * e2).normalized();
  result.point += x[2] * e1 + x[3] * e2;
  result.radius = x[4];
  if (start.kind == product::FaceKind::kCone) result.half_angle = x[5];
  if (start.kind == product::FaceKind::kTorus) {
    result.point += x[5] * start.axis;
    result.tube_radius = x[6];
  }
  return result;
}

Eigen::VectorXd parameters(const SimpleSurface& start) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(parameters_of(start.kind));
  x[start.kind == product::FaceKind::kSphere ? 3 : 4] = start.radius;
  if (start.kind == product::FaceKind::kCone) x[5] = start.half_angle;
  if (start.kind == product::FaceKind::kTorus) x[6] = start.tube_radius;
  return x;
}

/// Levenberg-Marquardt from one start; the points are about 1 in size, about the origin.
SurfaceFit refine(const SimpleSurface& start, std::span<const Vec3> points, double largest_radius,
                  int iterations) {
  const auto n = static_cast<Eigen::Index>(points.size());
  const auto residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    const SimpleSurface surface = moved(start, x);
    r.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      r[i] = distance_to(surface, points[i]);
    }
  };
  geometry::LeastSquaresProblem problem;
  problem.evaluate = geometry::with_numeric_jacobian(
      residual, [](Eigen::Index, double x) { return 1e-6 * std::max(1.0, std::abs(x)); });
  const Eigen::VectorXd x = parameters(start);
  problem.lower = Eigen::VectorXd::Constant(x.size(), -10.0 * largest_radius);
  problem.upper = -problem.lower;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (x[k] != 0.0) problem.lower[k] = 1e-6;  // radii
    if (x[k] != 0.0) problem.upper[k] = largest_radius;
  }
  if (start.kind == product::FaceKind::kCone) {
    problem.lower[5] = -1.5;  // a cone may turn round while it is sought
    problem.upper[5] = 1.5;
  }
  const geometry::LeastSquaresSolution solution = geometry::solve_least_squares(
      problem, x, {.max_iterations = iterations, .step_tolerance = 1e-10});
  SurfaceFit fit;
  if (solution.status == geometry::LeastSquaresStatus::kBadStart) {
    fit.rms = fit.max = std::numeric_limits<double>::infinity();
    return fit;
  }
  fit.surface = moved(start, solution.x);
  fit.has_converged = solution.status != geometry::LeastSquaresStatus::kIterationLimit &&
                      std::none_of(solution.at_bound.begin(), solution.at_bound.end(),
                                   [](char at) { return at != 0; });
  fit.rms = std::sqrt(solution.sum_of_squares / static_cast<double>(n));
  fit.max = solution.residual.cwiseAbs().maxCoeff();
  return fit;
}

struct Circle {
  Eigen::Vector2d centre;
  double radius = 0.0;
};

/// Kasa 1976: |p|^2 = 2 c . p + (r^2 - |c|^2), linear in c and the bracket.
std::optional<Circle> circle_through(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  for (const Eigen::Vector2d& p : points) {
    const Vec3 row(2.0 * p.x(), 2.0 * p.y(), 1.0);
    a += row * row.transpose();
    b += p.squaredNorm() * row;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(a);
  if (lu.rank() < 3) return {};
  const Vec3 x = lu.solve(b);
  const double squared = x[2] + x.head<2>().squaredNorm();
  if (!(squared > 0.0)) return {};
  return Circle{x.head<2>(), std::sqrt(squared)};
}

struct Axes {
  std::array<Vec3, 3> direction;  // the narrowest extent first
};

Axes principal_axes(std::span<const Vec3> points, const Vec3& about) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& x : points) covariance += (x - about) * (x - about).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return {
      {solver.eigenvectors().col(0), solver.eigenvectors().col(1), solver.eigenvectors().col(2)}};
}

Vec3 mean_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : points) sum += x;
  return points.empty() ? sum : Vec3(sum / static_cast<double>(points.size()));
}

/// z = (k1 u^2 + k2 v^2) / 2 about the point of the surface next to the middle.
struct Paraboloid {
  Vec3 point, normal, first, second;  // principal directions
  double k1 = 0.0, k2 = 0.0;
};

std::optional<Paraboloid> paraboloid_through(std::span<const Vec3> points, const Vec3& normal) {
  if (points.size() < 6) return {};
  const auto [e1, e2] = across(normal);
  Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), 6);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Vec3& x = points[i];
    const double u = x.dot(e1), v = x.dot(e2);
    a.row(i) << 1.0, u, v, 0.5 * u * u, u * v, 0.5 * v * v;
    b[i] = x.dot(normal);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  if (qr.rank() < 6) return {};
  const Eigen::VectorXd c = qr.solve(b);
  Eigen::Matrix2d second;
  second << c[3], c[4], c[4], c[5];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(second);
  Paraboloid result;
  result.normal = (normal - c[1] * e1 - c[2] * e2).normalized();
  result.point = c[0] * normal;
  const auto direction = [&, &first = e1, &second = e2](int k) -> Vec3 {
    const Eigen::Vector2d d = solver.eigenvectors().col(k);
    const Vec3 along = d[0] * first + d[1] * second;
    return (along - along.dot(result.normal) * result.normal).normalized();
  };
  result.first = direction(0);
  result.second = result.normal.cross(result.first);
  result.k1 = solver.eigenvalues()[0];
  result.k2 = solver.eigenvalues()[1];
  return result;
}

/// Starts from the surface's curvatures: those that bend enough.
void add_osculating(product::FaceKind kind, const Paraboloid& p, double largest_radius,
                    std::vector<SimpleSurface>& starts) {
  const double least = 1.0 / largest_radius;
  for (const bool is_swapped : {false, true}) {
    const double bent = is_swapped ? p.k2 : p.k1;  // across the axis of a cylinder
    const double along = is_swapped ? p.k1 : p.k2;
    const Vec3 bent_direction = is_swapped ? p.second : p.first;
    const Vec3 along_direction = is_swapped ? p.first : p.second;
    if (std::abs(bent) < least) continue;
    SimpleSurface start{.kind = kind};
    start.point = p.point + p.normal / bent;
    start.radius = 1.0 / std::abs(bent);
    start.axis = along_direction;
    if (kind == product::FaceKind::kCone) {
      for (const double slope : {-0.15, 0.15}) {
        start.half_angle = slope;
        starts.push_back(start);
      }
      continue;
    }
    if (kind == product::FaceKind::kTorus) {
      // A circle of radius 1 / bent turns about an axis through the other centre of curvature.
      const double turn = std::copysign(1.0 / std::max(std::abs(along), 2.0 * least), along);
      start.point = p.point + turn * p.normal;
      start.axis = bent_direction;
      start.tube_radius = 1.0 / std::abs(bent);
      start.radius = std::abs(turn - 1.0 / bent);
      if (start.radius < 1e-3) start.radius = 0.05;
    }
    starts.push_back(start);
  }
}

/// Starts about a direction: a circle in the projection along it, and what the section says.
void add_about(product::FaceKind kind, const Vec3& axis, std::span<const Vec3> points,
               std::vector<SimpleSurface>& starts) {
  const auto [e1, e2] = across(axis);
  std::vector<Eigen::Vector2d> flat;
  for (const Vec3& x : points) flat.emplace_back(x.dot(e1), x.dot(e2));
  const auto circle = circle_through(flat);
  if (!circle) return;
  SimpleSurface start{.kind = kind, .axis = axis, .radius = circle->radius};
  start.point = circle->centre.x() * e1 + circle->centre.y() * e2;
  if (kind != product::FaceKind::kCone && kind != product::FaceKind::kTorus) {
    starts.push_back(start);
    return;
  }
  std::vector<Eigen::Vector2d> section;  // along the axis, from the axis
  for (const Vec3& x : points) {
    const Vec3 way = x - start.point;
    section.emplace_back(way.dot(axis), (way - way.dot(axis) * axis).norm());
  }
  if (kind == product::FaceKind::kTorus) {
    const auto tube = circle_through(section);
    if (!tube || !(tube->centre.y() > 0.0)) return;
    start.point += tube->centre.x() * axis;
    start.radius = tube->centre.y();
    start.tube_radius = tube->radius;
    starts.push_back(start);
    return;
  }
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : section) {
    const Eigen::Vector2d row(1.0, p.x());
    a += row * row.transpose();
    b += p.y() * row;
  }
  const Eigen::FullPivLU<Eigen::Matrix2d> lu(a);
  if (lu.rank() < 2) return;
  const Eigen::Vector2d line = lu.solve(b);
  start.radius = std::max(1e-3, line[0]);
  start.half_angle = std::atan(line[1]);
  if (std::abs(start.half_angle) < 0.02) start.half_angle = 0.02;
  starts.push_back(start);
}

SurfaceFit plane_through(std::span<const Vec3> points) {
  SurfaceFit fit;
  fit.surface.point = mean_of(points);
  fit.surface.axis = principal_axes(points, fit.surface.point).direction[0];
  double sum = 0.0;
  for (const Vec3& x : points) {
    const double d = distance_to(fit.surface, x);
    sum += d * d;
    fit.max = std::max(fit.max, std::abs(d));
  }
  fit.rms = std::sqrt(sum / static_cast<double>(points.size()));
  fit.has_converged = true;
  return fit;
}

/// A cone is recognised by where it widens; a plane by the side of the material.
void settle(SimpleSurface& s, std::span<const Vec3> points, std::span<const Vec3> normals) {
  if (s.kind == product::FaceKind::kPlane && !normals.empty() &&
      mean_of(normals).dot(s.axis) < 0.0) {
    s.axis = -s.axis;
  }
  if (s.kind == product::FaceKind::kCone && s.half_angle < 0.0) {
    s.half_angle = -s.half_angle;
    s.axis = -s.axis;
  }
  // The point of an axis next to the middle of the points.
  if (s.kind == product::FaceKind::kCylinder || s.kind == product::FaceKind::kCone) {
    const double way = (mean_of(points) - s.point).dot(s.axis);
    s.point += way * s.axis;
    if (s.kind == product::FaceKind::kCone) s.radius += way * std::tan(s.half_angle);
  }
}

void check_range(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw UsageError(fmt::format("surface fit: {} is {:.6g}{}; {:.6g} to {:.6g}{} is allowed", name,
                               value, unit, low, high, unit));
}

}  // namespace

void SurfaceFitOptions::check() const {
  check_range("tolerance", tolerance, 0.0, 10.0, " mm");
  check_range("preference of simpler surfaces", preference, 1.0, 100.0, "");
  check_range("largest radius", largest_radius, 1.0, 1e6, " mm");
  check_range("smallest radius", smallest_radius, 0.0, largest_radius, " mm");
}

double distance_to(const SimpleSurface& s, const Vec3& x) {
  const Vec3 way = x - s.point;
  const double along = way.dot(s.axis);
  if (s.kind == product::FaceKind::kPlane) return along;
  if (s.kind == product::FaceKind::kSphere) return way.norm() - s.radius;
  const double off = (way - along * s.axis).norm();
  switch (s.kind) {
    case product::FaceKind::kCone:
      return (off - s.radius) * std::cos(s.half_angle) - along * std::sin(s.half_angle);
    case product::FaceKind::kTorus:
      return std::hypot(off - s.radius, along) - s.tube_radius;
    default:
      return off - s.radius;
  }
}

std::string title_of(const SimpleSurface& s) {
  switch (s.kind) {
    case product::FaceKind::kPlane:
    case product::FaceKind::kFreeform:
      break;
    case product::FaceKind::kSphere:
    case product::FaceKind::kCylinder:
      return fmt::format("{} r {:.4g} mm", name_of(s.kind), s.radius);
    case product::FaceKind::kCone:
      return fmt::format("cone r {:.4g} mm, half angle {:.3g} deg", s.radius,
                         s.half_angle * geometry::kDegreesPerRadian);
    case product::FaceKind::kTorus:
      return fmt::format("torus r {:.4g} mm, tube {:.4g} mm", s.radius, s.tube_radius);
  }
  return name_of(s.kind);
}

SurfaceFit fit_surface(product::FaceKind kind, std::span<const Vec3> points,
                       std::span<const Vec3> normals, const SurfaceFitOptions& options) {
  options.check();
  const int least = parameters_of(kind);
  if (points.size() < static_cast<std::size_t>(least)) {
    throw UsageError(fmt::format("surface fit: {} points; a {} needs at least {}", points.size(),
                                 name_of(kind), least));
  }
  if (!normals.empty() && normals.size() != points.size()) {
    throw UsageError(
        fmt::format("surface fit: {} normals for {} points", normals.size(), points.size()));
  }
  SurfaceFit fit;
  if (kind == product::FaceKind::kPlane) {
    fit = plane_through(points);
    settle(fit.surface, points, normals);
    return fit;
  }
  // In a frame in which the points are about 1 in size, so that tolerances mean something.
  const Vec3 middle = mean_of(points);
  double scale = 0.0;
  for (const Vec3& x : points) scale = std::max(scale, (x - middle).norm());
  if (!(scale > 0.0)) {
    fit.rms = fit.max = std::numeric_limits<double>::infinity();
    return fit;
  }
  std::vector<Vec3> all, some, some_normals;
  for (const Vec3& x : points) all.push_back((x - middle) / scale);
  const std::size_t step = (all.size() + kPointsOfAStart - 1) / kPointsOfAStart;
  for (std::size_t i = 0; i < all.size(); i += step) {
    some.push_back(all[i]);
    if (!normals.empty()) some_normals.push_back(normals[i]);
  }
  if (some.size() < static_cast<std::size_t>(least)) some = all;
  const double largest = options.largest_radius / scale;
  std::vector<SimpleSurface> starts;
  const Axes axes = principal_axes(all, Vec3::Zero());
  for (const Vec3& axis : axes.direction) add_about(kind, axis, some, starts);
  Vec3 normal = axes.direction[0];
  if (!some_normals.empty()) {
    for (const Vec3& axis : principal_axes(some_normals, Vec3::Zero()).direction) {
      add_about(kind, axis, some, starts);
    }
    add_about(kind, principal_axes(some_normals, mean_of(some_normals)).direction[0], some, starts);
    if (mean_of(some_normals).norm() > 0.3) normal = mean_of(some_normals).normalized();
  }
  if (const auto paraboloid = paraboloid_through(some, normal)) {
    add_osculating(kind, *paraboloid, largest, starts);
  }
  fit.rms = std::numeric_limits<double>::infinity();
  for (const SimpleSurface& start : starts) {
    const SurfaceFit one = refine(start, some, largest, 60);
    if (one.rms < fit.rms) fit = one;
  }
  if (!std::isfinite(fit.rms)) {
    fit.max = fit.rms;
    return fit;
  }
  SimpleSurface& s = fit.surface;
  if (s.radius > 0.0) fit = refine(s, all, largest, 200);
  s.point = middle + scale * s.point;
  s.radius *= scale;
  s.tube_radius *= scale;
  fit.rms *= scale;
  fit.max *= scale;
  settle(s, points, normals);
  const double bend = kind == product::FaceKind::kTorus ? s.tube_radius : s.radius;
  if (kind != product::FaceKind::kCone && bend < options.smallest_radius) fit.has_converged = false;
  return fit;
}

SurfaceChoice choose_surface(std::span<const Vec3> points, std::span<const Vec3> normals,
                             const SurfaceFitOptions& options) {
  SurfaceChoice choice;
  double least = std::numeric_limits<double>::infinity();
  for (const product::FaceKind kind : kKinds) {
    if (kind != product::FaceKind::kPlane &&
        points.size() < static_cast<std::size_t>(parameters_of(kind))) {
      continue;
    }
    choice.fits.push_back(fit_surface(kind, points, normals, options));
    if (choice.fits.back().has_converged) least = std::min(least, choice.fits.back().rms);
  }
  const double enough = std::max(options.tolerance, options.preference * least);
  while (!choice.best().has_converged || choice.best().rms > enough) ++choice.chosen;
  return choice;
}

std::vector<std::vector<int>> split_patch(std::span<const Vec3> points,
                                          std::span<const Vec3> normals,
                                          const PatchSplitOptions& split,
                                          const SurfaceFitOptions& options) {
  if (normals.size() != points.size()) {
    throw UsageError(
        fmt::format("surface fit: {} normals for {} points", normals.size(), points.size()));
  }
  std::vector<std::vector<int>> pieces;
  const auto visit = [&](const auto& self, const std::vector<int>& piece, int depth) -> void {
    std::vector<Vec3> at, out;
    for (const int i : piece) {
      at.push_back(points[i]);
      out.push_back(normals[i]);
    }
    const bool may_split =
        depth < split.largest_depth && static_cast<int>(piece.size()) >= 2 * split.least_points;
    if (!may_split || choose_surface(at, out, options).best().rms <= split.tolerance) {
      pieces.push_back(piece);
      return;
    }
    // Two means of the normals, apart along the direction in which they differ most.
    const Vec3 middle = mean_of(out);
    const Vec3 widest = principal_axes(out, middle).direction[2];
    Vec3 first = middle + 0.3 * widest, second = middle - 0.3 * widest;
    std::vector<int> one, other;
    for (int round = 0; round < 20; ++round) {
      one.clear();
      other.clear();
      Vec3 sum_one = Vec3::Zero(), sum_other = Vec3::Zero();
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const bool is_first = (out[k] - first).squaredNorm() <= (out[k] - second).squaredNorm();
        (is_first ? one : other).push_back(piece[k]);
        (is_first ? sum_one : sum_other) += out[k];
      }
      if (one.empty() || other.empty()) break;
      first = sum_one / static_cast<double>(one.size());
      second = sum_other / static_cast<double>(other.size());
    }
    if (static_cast<int>(std::min(one.size(), other.size())) < split.least_points) {
      pieces.push_back(piece);
      return;
    }
    self(self, one, depth + 1);
    self(self, other, depth + 1);
  };
  std::vector<int> all(points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  if (!all.empty()) visit(visit, all, 0);
  return pieces;
}

}  // namespace palmar::redesign
