// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "palmar/core/error.h"

namespace palmar {
namespace {

using Edge = std::array<int, 2>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

std::vector<SectionCurve> plane_section(const TriangleMesh& mesh, const Vec3& point,
                                        const Vec3& normal) {
  if (!(std::abs(normal.norm() - 1.0) < 1e-9)) {
    throw UsageError("section plane: normal has length " + std::to_string(normal.norm()) +
                     "; a unit vector is required");
  }
  const auto height = [&](int i) {
    return normal.dot(mesh.vertices[static_cast<std::size_t>(i)] - point);
  };
  // Each crossed triangle is a piece from the edge through which its corners, walked in order,
  // leave the normal's side to the edge through which they come back.
  struct Piece {
    Edge from, to;
  };
  const auto edge = [](int a, int b) { return Edge{std::min(a, b), std::max(a, b)}; };
  std::vector<Piece> piece;
  std::map<Edge, std::vector<int>> starting;
  std::map<Edge, int> ending;
  for (const Triangle& t : mesh.triangles) {
    Piece p{};
    int crossings = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const bool is_above_a = height(a) >= 0.0, is_above_b = height(b) >= 0.0;
      if (is_above_a == is_above_b) continue;
      (is_above_b ? p.to : p.from) = edge(a, b);
      ++crossings;
    }
    if (crossings != 2) continue;
    starting[p.from].push_back(static_cast<int>(piece.size()));
    ++ending[p.to];
    piece.push_back(p);
  }
  const auto corner = [&](const Edge& e) -> Vec3 {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(e[0])];
    const Vec3& b = mesh.vertices[static_cast<std::size_t>(e[1])];
    const double ha = height(e[0]), hb = height(e[1]);
    return a + ha / (ha - hb) * (b - a);
  };
  std::vector<bool> is_used(piece.size());
  const auto follow = [&](std::size_t first) {
    SectionCurve curve;
    curve.point.push_back(corner(piece[first].from));
    std::size_t current = first;
    while (true) {
      is_used[current] = true;
      const Edge& end = piece[current].to;
      if (end == piece[first].from) {
        curve.is_closed = true;
        return curve;
      }
      curve.point.push_back(corner(end));
      const auto next = starting.find(end);
      if (next == starting.end()) return curve;
      const auto& options = next->second;
      const auto free = std::find_if(options.begin(), options.end(),
                                     [&](int i) { return !is_used[static_cast<std::size_t>(i)]; });
      if (free == options.end()) return curve;
      current = static_cast<std::size_t>(*free);
    }
  };
  std::vector<SectionCurve> curves;
  // Open curves first, from their ends; what is left are loops.
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (!is_used[i] && !ending.contains(piece[i].from)) curves.push_back(follow(i));
  }
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (!is_used[i]) curves.push_back(follow(i));
  }
  return curves;
}

double curve_length(const SectionCurve& curve) {
  double length = 0.0;
  const std::size_t n = curve.point.size();
  for (std::size_t i = 0; i + 1 < n; ++i) length += (curve.point[i + 1] - curve.point[i]).norm();
  if (curve.is_closed && n > 1) length += (curve.point.front() - curve.point.back()).norm();
  return length;
}

Vec3 curve_centre(const SectionCurve& curve) {
  const std::size_t n = curve.point.size();
  if (n == 0) return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  double length = 0.0;
  for (std::size_t i = 0; i < (curve.is_closed ? n : n - 1); ++i) {
    const Vec3& a = curve.point[i];
    const Vec3& b = curve.point[(i + 1) % n];
    sum += 0.5 * (b - a).norm() * (a + b);
    length += (b - a).norm();
  }
  return length > 0.0 ? Vec3(sum / length) : curve.point.front();
}

double extent(const std::vector<Vec3>& points, const Vec3& direction) {
  double lowest = std::numeric_limits<double>::max();
  double highest = -lowest;
  for (const Vec3& p : points) {
    lowest = std::min(lowest, p.dot(direction));
    highest = std::max(highest, p.dot(direction));
  }
  return points.empty() ? 0.0 : highest - lowest;
}

double girth(const std::vector<Vec3>& points, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  std::vector<Eigen::Vector2d> flat;
  for (const Vec3& p : points) flat.emplace_back(u.dot(p), v.dot(p));
  std::sort(flat.begin(), flat.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  // Monotone chain (Andrew 1979): lower hull forwards, upper hull backwards.
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Eigen::Vector2d& p : flat) {
      while (hull.size() >= begin + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();  // it begins the other chain
    std::reverse(flat.begin(), flat.end());
  }
  double length = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    length += (hull[(i + 1) % hull.size()] - hull[i]).norm();
  }
  return length;
}

}  // namespace palmar
