// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_section.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/geometry/section.h"

namespace palmar {
namespace {

constexpr double kSpacing = 0.4;  // mm between samples of the outline

double area_of(const std::vector<Eigen::Vector2d>& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

}  // namespace

HandleSection::HandleSection(const TriangleMesh& mesh, const Vec3& point, const Vec3& axis,
                             const Vec3& first, const Vec3& second) {
  double largest = 0.0;
  for (const SectionCurve& curve : plane_section(mesh, point, axis)) {
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
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d step = outline_[(i + 1) % n] - outline_[i];
    const double length = step.norm();
    if (length < 1e-9) continue;
    const Eigen::Vector2d inward(-step.y() / length, step.x() / length);
    const int parts = std::max(1, static_cast<int>(std::ceil(length / kSpacing)));
    for (int k = 0; k < parts; ++k) {
      const double share = (k + 0.5) / parts;
      samples_.push_back({outline_[i] + share * step, inward, way_[i] + share * length});
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
  const double tolerance = 0.004 * radius;
  std::vector<SectionRidge> ridges;
  std::size_t first = 0;
  while (first < n && missing[first] > tolerance) ++first;
  if (first == n) return ridges;  // nowhere room for the disc
  std::size_t best = n;
  for (std::size_t k = 1; k <= n; ++k) {
    const std::size_t i = (first + k) % n;
    if (missing[i] > tolerance) {
      if (best == n || missing[i] > missing[best]) best = i;
      continue;
    }
    if (best < n) {
      // In the middle of those that miss the most: a tip that is round has many.
      std::size_t begin = best, end = best;
      while (missing[(begin + n - 1) % n] > 0.98 * missing[best]) begin = (begin + n - 1) % n;
      while (missing[(end + 1) % n] > 0.98 * missing[best]) end = (end + 1) % n;
      double way = samples_[end].way - samples_[begin].way;
      if (way < 0.0) way += way_.back();
      SectionRidge ridge;
      ridge.way = std::fmod(samples_[begin].way + 0.5 * way, way_.back());
      ridge.apex =
          nearest(samples_[(begin + (end + n - begin) % n / 2) % n].at, ridge.way - 1e-6, 2e-6);
      const double turn =
          std::acos(std::clamp(samples_[begin].inward.dot(samples_[end].inward), -1.0, 1.0));
      ridge.radius = turn > 0.05 ? way / turn : 0.0;
      ridges.push_back(ridge);
      best = n;
    }
  }
  return ridges;
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

}  // namespace palmar
