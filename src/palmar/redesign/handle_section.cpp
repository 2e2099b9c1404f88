// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_section.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/section.h"

namespace palmar::redesign {
namespace {

constexpr double kSpacing = 0.4;  // mm between samples of the outline
constexpr double kKink = 0.35;    // rad; facets of a round side turn less
constexpr double kBent = 1.5;     // mm; facets of a round side are about twice as long

double area_of(const std::vector<Eigen::Vector2d>& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

}  // namespace

HandleSection::HandleSection(const geometry::TriangleMesh& mesh, const Vec3& point,
                             const Vec3& axis, const Vec3& first, const Vec3& second) {
  double largest = 0.0;
  for (const geometry::SectionCurve& curve : geometry::plane_section(mesh, point, axis)) {
    if (!curve.is_closed) continue;
    std::vector<Eigen::Vector2d> flat;
    for (const Vec3& x : curve.point) {
      const Eigen::Vector2d p(x.dot(first), x.dot(second));
      if (flat.empty() || (p - flat.back()).norm() > 1e-9) flat.push_back(p);
    }
    const double area = area_of(flat);
    if (std::abs(area) <= largest) continue;
    largest = std::abs(area);
    if (area < 0.0) std::reverse(flat.begin(), flat.end());
    outline_ = std::move(flat);
  }
  if (outline_.size() < 3) {
    throw UsageError("relief: the plane across the handle cuts no closed outline");
  }
  const std::size_t n = outline_.size();
  way_.assign(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    way_[i + 1] = way_[i] + (outline_[(i + 1) % n] - outline_[i]).norm();
  }
  std::vector<Eigen::Vector2d> inward(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d step = (outline_[(i + 1) % n] - outline_[i]).normalized();
    inward[i] = Eigen::Vector2d(-step.y(), step.x());
  }
  // Facets of a round side share the direction at their corner; a kink has both.
  const auto at_corner = [&](std::size_t corner, std::size_t facet) -> Eigen::Vector2d {
    const Eigen::Vector2d &before = inward[(corner + n - 1) % n], &after = inward[corner % n];
    return before.dot(after) > std::cos(kKink) ? Eigen::Vector2d((before + after).normalized())
                                               : inward[facet];
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d step = outline_[(i + 1) % n] - outline_[i];
    const Eigen::Vector2d first_way = at_corner(i, i), last_way = at_corner(i + 1, i);
    const int parts = std::max(1, static_cast<int>(std::ceil(step.norm() / kSpacing)));
    // Long facets are flat: only their ends bend.
    const double bent = std::min(0.5, kBent / step.norm());
    for (int k = 0; k < parts; ++k) {
      const double share = (k + 0.5) / parts;
      const double to_last = std::max(0.0, (share - 1.0 + bent) / bent);
      const double to_first = std::max(0.0, (bent - share) / bent);
      const Eigen::Vector2d direction =
          inward[i] + to_last * (last_way - inward[i]) + to_first * (first_way - inward[i]);
      samples_.push_back(
          {outline_[i] + share * step, direction.normalized(), way_[i] + share * step.norm()});
    }
  }
  // The largest disc: a grid that narrows down on its best point.
  Eigen::Vector2d low = outline_[0], high = outline_[0];
  for (const Eigen::Vector2d& p : outline_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Eigen::Vector2d centre = 0.5 * (low + high);
  double size = 0.5 * (high - low).maxCoeff();
  for (int round = 0; round < 12; ++round, size *= 0.4) {
    const Eigen::Vector2d before = centre;
    for (int i = -5; i <= 5; ++i) {
      for (int j = -5; j <= 5; ++j) {
        const Eigen::Vector2d x = before + size / 5.0 * Eigen::Vector2d(i, j);
        if (!is_inside(x)) continue;
        const double d = distance(x);
        if (d > largest_disc_) {
          largest_disc_ = d;
          centre = x;
        }
      }
    }
  }
}

bool HandleSection::is_inside(const Eigen::Vector2d& x) const {
  bool inside = false;
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    const Eigen::Vector2d &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
    if ((a.y() > x.y()) == (b.y() > x.y())) continue;
    if (x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

Eigen::Vector2d HandleSection::nearest(const Eigen::Vector2d& x, double from, double length) const {
  const std::size_t n = outline_.size();
  const double whole = way_[n];
  Eigen::Vector2d best = outline_[0];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const double edge = way_[i + 1] - way_[i];
    if (edge < 1e-12) continue;
    // The part of the edge inside [from, from + length], the outline being a ring.
    for (const double turn : {-whole, 0.0, whole}) {
      const double begin = std::clamp((from + turn - way_[i]) / edge, 0.0, 1.0);
      const double end = std::clamp((from + turn + length - way_[i]) / edge, 0.0, 1.0);
      if (!(end > begin)) continue;
      const Eigen::Vector2d a = outline_[i], step = outline_[(i + 1) % n] - a;
      const double share = std::clamp((x - a).dot(step) / step.squaredNorm(), begin, end);
      const Eigen::Vector2d p = a + share * step;
      const double d = (p - x).squaredNorm();
      if (d < least) {
        least = d;
        best = p;
      }
    }
  }
  return best;
}

double HandleSection::distance(const Eigen::Vector2d& x) const {
  return (nearest(x, 0.0, way_.back()) - x).norm();
}

std::vector<SectionRidge> HandleSection::ridges(double radius) const {
  // How far short of the disc's radius the free space under each sample stays: 0 on flanks.
  const std::size_t n = samples_.size();
  std::vector<double> missing(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d centre = samples_[i].at + radius * samples_[i].inward;
    missing[i] = is_inside(centre) ? radius - distance(centre) : radius;
  }
  // Facets of a round outline stand off it by as much as this.
  const double tolerance = 0.01 * radius;
  std::vector<SectionRidge> ridges;
  std::size_t first = 0;
  while (first < n && missing[first] > tolerance) ++first;
  if (first == n) return ridges;  // nowhere room for the disc
  const auto disc_at = [&](std::size_t i) -> Eigen::Vector2d {
    return samples_[i].at + radius * samples_[i].inward;
  };
  std::size_t begin = n;  // of the part that the disc doesn't reach
  for (std::size_t k = 1; k <= n; ++k) {
    const std::size_t i = (first + k) % n;
    if (missing[i] > tolerance) {
      if (begin == n) begin = i;
      continue;
    }
    if (begin == n) continue;
    // The discs that stop on both sides are the same, but for the spacing of samples; the tip is
    // farthest from it.
    const Eigen::Vector2d centre = 0.5 * (disc_at((begin + n - 1) % n) + disc_at(i));
    std::size_t tip = begin;
    double most = 0.0;
    for (std::size_t m = begin; m != i; m = (m + 1) % n) {
      if ((samples_[m].at - centre).norm() > (samples_[tip].at - centre).norm()) tip = m;
      most = std::max(most, missing[m]);
    }
    begin = n;
    if (most < 4.0 * tolerance) continue;  // facets of a round side
    ridges.push_back({samples_[tip].at, samples_[tip].way, tip_radius(samples_[tip].way)});
  }
  return ridges;
}

double HandleSection::tip_radius(double way) const {
  // Kasa's circle through the outline near the tip; a kink has no radius.
  constexpr double kReach = 1.5;  // mm
  const std::size_t n = outline_.size();
  const auto is_near = [&](double at) {
    const double off = std::abs(at - way);
    return std::min(off, way_[n] - off) <= kReach;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_near(way_[i])) continue;
    const Eigen::Vector2d in = (outline_[i] - outline_[(i + n - 1) % n]).normalized();
    const Eigen::Vector2d out = (outline_[(i + 1) % n] - outline_[i]).normalized();
    if (in.dot(out) < std::cos(kKink)) return 0.0;
  }
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  const Eigen::Vector2d origin = nearest(samples_.front().at, way - 1e-6, 2e-6);
  for (const Sample& one : samples_) {
    if (!is_near(one.way)) continue;
    const Eigen::Vector2d p = one.at - origin;
    const Vec3 row(2.0 * p.x(), 2.0 * p.y(), 1.0);
    a += row * row.transpose();
    b += p.squaredNorm() * row;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(a);
  if (lu.rank() < 3) return 0.0;
  const Vec3 x = lu.solve(b);
  return std::sqrt(std::max(0.0, x[2] + x.head<2>().squaredNorm()));
}

std::optional<SectionRidge> HandleSection::ridge_near(const Eigen::Vector2d& point,
                                                      double radius) const {
  std::optional<SectionRidge> best;
  double least = 10.0;
  for (const SectionRidge& ridge : ridges(std::min(radius, 0.999 * largest_disc_))) {
    const double d = (ridge.apex - point).norm();
    if (d < least) {
      least = d;
      best = ridge;
    }
  }
  return best;
}

std::optional<TouchingDisc> HandleSection::disc_under(const SectionRidge& ridge,
                                                      double radius) const {
  const double half = 0.5 * way_.back();
  // Newton: both flanks at the distance of the radius.
  const Sample* tip = &samples_.front();
  for (const Sample& one : samples_) {
    if ((one.at - ridge.apex).norm() < (tip->at - ridge.apex).norm()) tip = &one;
  }
  Eigen::Vector2d inward = Eigen::Vector2d::Zero();
  for (const Sample& one : samples_) {
    if ((one.at - ridge.apex).norm() < 0.5 * radius) inward += one.inward;
  }
  if (inward.norm() < 1e-6) inward = tip->inward;
  Eigen::Vector2d x = ridge.apex + 1.2 * radius * inward.normalized();
  if (!is_inside(x)) x = ridge.apex + radius * inward.normalized();
  TouchingDisc disc;
  for (int round = 0; round < 60; ++round) {
    const Eigen::Vector2d a = nearest(x, ridge.way, half), b = nearest(x, ridge.way - half, half);
    const double da = (a - x).norm(), db = (b - x).norm();
    if (da < 1e-9 || db < 1e-9) return {};
    disc = {x, (a - x) / da, (b - x) / db};
    const Eigen::Vector2d miss(radius - da, radius - db);
    if (miss.cwiseAbs().maxCoeff() < 1e-9) break;
    Eigen::Matrix2d gradient;  // of the distances by x
    gradient.row(0) = -disc.touch_first.transpose();
    gradient.row(1) = -disc.touch_second.transpose();
    if (std::abs(gradient.determinant()) < 1e-6) return {};
    Eigen::Vector2d step = gradient.inverse() * miss;
    if (step.norm() > 0.5 * radius) step *= 0.5 * radius / step.norm();
    x += step;
  }
  if (!is_inside(disc.centre) || std::abs(distance(disc.centre) - radius) > 1e-3 * radius ||
      disc.touch_first.dot(disc.touch_second) > 1.0 - 1e-4) {
    return {};
  }
  return disc;
}

}  // namespace palmar::redesign
