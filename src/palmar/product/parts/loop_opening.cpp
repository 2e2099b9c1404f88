// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/loop_opening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/geometry/mesh/section.h"
#include "palmar/product/parts/part_outline.h"

namespace palmar::product {
namespace {

using Point2 = Eigen::Vector2d;

// Distance to the nearest side of a polygon, negative outside.
double depth_in(const std::vector<Point2>& polygon, const Point2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 a = polygon[i], ab = polygon[(i + 1) % polygon.size()] - a;
    const double squared = ab.squaredNorm();
    const double t = squared > 0.0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - t * ab).norm());
  }
  return holds(polygon, p) ? least : -least;
}

// Steps that halve, from a start to the centre of the largest disc near it.
std::pair<Point2, double> disc_near(const std::vector<Point2>& polygon, Point2 best, double step) {
  constexpr int kDirections = 24;  // a ridge may run in any
  double radius = depth_in(polygon, best);
  while (step > 1e-3) {
    bool is_better = false;
    for (int k = 0; k < kDirections; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / kDirections;
      const Point2 p = best + step * Point2(std::cos(turn), std::sin(turn));
      const double r = depth_in(polygon, p);
      if (r > radius) {
        radius = r;
        best = p;
        is_better = true;
      }
    }
    if (!is_better) step *= 0.5;
  }
  return {best, radius};
}

// Centre and radius of the largest disc in a polygon: from every good point of a lattice, so that
// the answer doesn't depend on how the polygon lies to the lattice.
std::pair<Point2, double> largest_disc(const std::vector<Point2>& polygon) {
  constexpr int kLattice = 16;
  constexpr double kGood = 0.9;  // share of the best point's depth
  Point2 low = polygon.front(), high = low;
  for (const Point2& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<std::pair<double, Point2>> starts;
  double deepest = 0.0;
  for (int i = 1; i < kLattice; ++i) {
    for (int j = 1; j < kLattice; ++j) {
      const Point2 p(low.x() + (high.x() - low.x()) * i / kLattice,
                     low.y() + (high.y() - low.y()) * j / kLattice);
      starts.emplace_back(depth_in(polygon, p), p);
      deepest = std::max(deepest, starts.back().first);
    }
  }
  std::pair<Point2, double> best = {0.5 * (low + high), 0.0};
  for (const auto& [depth, p] : starts) {
    if (depth < kGood * deepest) continue;
    const auto found = disc_near(polygon, p, (high - low).maxCoeff() / kLattice);
    if (found.second > best.second) best = found;
  }
  return best;
}

// Whether a point is in the solid that oriented curves bound (overlapping solids count once).
bool is_in_solid(const std::vector<std::vector<Point2>>& curves, const Point2& p) {
  int winding = 0;
  for (const std::vector<Point2>& curve : curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Point2 &a = curve[i], &b = curve[(i + 1) % curve.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x > p.x()) winding += b.y() > a.y() ? 1 : -1;
    }
  }
  return winding > 0;
}

// The opening as cells of air, for solids that only overlap, so that no curve is its outline: from
// the middle of the loop on until the solid. Empty if it leads out of the loop.
std::vector<Point2> air_from(const std::vector<std::vector<Point2>>& curves,
                             const std::vector<Point2>& round, double cell) {
  Point2 low = round.front(), high = low;
  for (const Point2& p : round) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int nx = static_cast<int>((high.x() - low.x()) / cell) + 3;
  const int ny = static_cast<int>((high.y() - low.y()) / cell) + 3;
  const auto at = [&](int i, int j) {
    return Point2(low.x() + (i - 1) * cell, low.y() + (j - 1) * cell);
  };
  std::vector<char> state(static_cast<std::size_t>(nx) * ny, 0);
  std::vector<std::array<int, 2>> stack;
  // Start: the cell of air in the loop that is nearest to its middle.
  double nearest = std::numeric_limits<double>::infinity();
  std::array<int, 2> start = {-1, -1};
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Point2 p = at(i, j);
      if (p.norm() >= nearest || !holds(round, p) || is_in_solid(curves, p)) continue;
      nearest = p.norm();
      start = {i, j};
    }
  }
  if (start[0] < 0) return {};
  std::vector<Point2> air;
  stack.push_back(start);
  state[start[0] + static_cast<std::size_t>(nx) * start[1]] = 1;
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    air.push_back(at(i, j));
    if (i == 0 || j == 0 || i + 1 == nx || j + 1 == ny) return {};
    constexpr std::array<std::array<int, 2>, 4> kSteps = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (const auto& [di, dj] : kSteps) {
      char& s = state[i + di + static_cast<std::size_t>(nx) * (j + dj)];
      if (s != 0) continue;
      s = 1;
      if (!is_in_solid(curves, at(i + di, j + dj))) stack.push_back({i + di, j + dj});
    }
  }
  return air;
}

double nearest_distance(const std::vector<std::vector<Point2>>& curves, const Point2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<Point2>& curve : curves) least = std::min(least, distance_to(curve, p));
  return least;
}

PartOpening opening_of(const PlaneFrame& plane, const OutlineMeasures& hull, const Point2& centre,
                       double radius, double margin) {
  PartOpening result;
  result.centre = plane.lift(centre);
  result.axis = plane.normal;
  result.wide = hull.wide;
  result.disc = 2.0 * radius;
  result.width = hull.width + margin;
  result.height = hull.thickness + margin;
  if (result.height > result.width) {
    std::swap(result.width, result.height);
    result.wide = plane.normal.cross(hull.wide);
  }
  return result;
}

}  // namespace

std::optional<PartOpening> loop_opening(const geometry::TriangleMesh& mesh,
                                        const std::vector<Vec3>& line) {
  if (line.size() < 3) return {};
  Vec3 mean = Vec3::Zero(), area = Vec3::Zero();
  for (std::size_t i = 0; i < line.size(); ++i) {
    area += (line[i] - line[0]).cross(line[(i + 1) % line.size()] - line[0]);
  }
  if (!(area.norm() > 1e-6)) return {};
  const Vec3 axis = area.normalized();
  double length = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 &a = line[i], &b = line[(i + 1) % line.size()];
    mean += 0.5 * (b - a).norm() * (a + b);
    length += (b - a).norm();
  }
  mean /= length;
  const PlaneFrame plane(mean, axis);
  std::vector<Point2> round;
  for (const Vec3& p : line) round.push_back(plane.project(p));
  std::vector<Point2> opening;
  std::vector<std::vector<Point2>> curves;
  double largest = 0.0;
  for (const geometry::SectionCurve& curve : geometry::plane_section(mesh, mean, axis)) {
    if (curve.point.size() < 3) continue;
    std::vector<Point2> polygon;
    Point2 middle = Point2::Zero();
    for (const Vec3& p : curve.point) {
      polygon.push_back(plane.project(p));
      middle += polygon.back();
    }
    middle /= static_cast<double>(polygon.size());
    curves.push_back(polygon);
    const double twice = -twice_area(polygon);  // openings run clockwise
    if (!curve.is_closed || twice <= largest) continue;
    if (!holds(round, middle) && !holds(polygon, Point2::Zero())) continue;
    largest = twice;
    opening = std::move(polygon);
  }
  if (!opening.empty()) {
    const auto hull = measure_hull(plane, opening);
    if (!hull) return {};
    const auto [centre, radius] = largest_disc(opening);
    return opening_of(plane, *hull, centre, radius, 0.0);
  }
  constexpr double kCell = 0.5;  // mm; 3 % of a finger
  const std::vector<Point2> air = air_from(curves, round, kCell);
  const auto hull = measure_hull(plane, air);
  if (!hull) return {};
  Point2 centre = air.front();
  double radius = 0.0;
  for (const Point2& p : air) {
    const double d = nearest_distance(curves, p);
    if (d > radius) {
      radius = d;
      centre = p;
    }
  }
  return opening_of(plane, *hull, centre, radius, kCell);
}

}  // namespace palmar::product
