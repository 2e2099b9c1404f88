// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/convex_hull.h"

namespace palmar::geometry {
namespace {

using MeshEdge = std::array<int, 2>;

}  // namespace

std::vector<SectionCurve> plane_section(const TriangleMesh& mesh, const Vec3& point,
                                        const Vec3& normal) {
  if (!(std::abs(normal.norm() - 1.0) < 1e-9)) {
    throw UsageError("section plane: normal has length " + std::to_string(normal.norm()) +
                     "; a unit vector is required");
  }
  const auto height = [&](int i) { return normal.dot(mesh.vertices[i] - point); };
  std::vector<char> side(mesh.vertices.size());
  for (std::size_t i = 0; i < side.size(); ++i) {
    side[i] = normal.dot(mesh.vertices[i] - point) >= 0.0 ? 1 : 0;
  }
  const auto is_above = [&](int i) { return side[i] != 0; };
  // Each crossed triangle is a piece from the edge through which its corners, walked in order,
  // leave the normal's side to the edge through which they come back.
  struct Piece {
    MeshEdge from, to;
  };
  const auto edge = [](int a, int b) { return MeshEdge{std::min(a, b), std::max(a, b)}; };
  std::vector<Piece> piece;
  for (const Triangle& t : mesh.triangles) {
    if (is_above(t[1]) == is_above(t[0]) && is_above(t[2]) == is_above(t[0])) continue;
    Piece p{};
    int crossings = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (is_above(a) == is_above(b)) continue;
      (is_above(b) ? p.to : p.from) = edge(a, b);
      ++crossings;
    }
    if (crossings != 2) continue;
    piece.push_back(p);
  }
  // Pieces by the edge where they start, and the edges where any ends.
  std::vector<std::pair<MeshEdge, std::size_t>> starting;
  std::vector<MeshEdge> ending;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    starting.emplace_back(piece[i].from, i);
    ending.push_back(piece[i].to);
  }
  std::sort(starting.begin(), starting.end());
  std::sort(ending.begin(), ending.end());
  const auto corner = [&](const MeshEdge& e) -> Vec3 {
    const Vec3& a = mesh.vertices[e[0]];
    const Vec3& b = mesh.vertices[e[1]];
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
      const MeshEdge& end = piece[current].to;
      if (end == piece[first].from) {
        curve.is_closed = true;
        return curve;
      }
      curve.point.push_back(corner(end));
      auto next =
          std::lower_bound(starting.begin(), starting.end(), std::pair(end, std::size_t{0}));
      while (next != starting.end() && next->first == end && is_used[next->second]) ++next;
      if (next == starting.end() || next->first != end) return curve;
      current = next->second;
    }
  };
  const auto ends = [&](const MeshEdge& e) {
    return std::binary_search(ending.begin(), ending.end(), e);
  };
  std::vector<SectionCurve> curves;
  // Open curves first, from their ends; what is left are loops.
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (!is_used[i] && !ends(piece[i].from)) curves.push_back(follow(i));
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
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(flat));
  double length = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    length += (hull[(i + 1) % hull.size()] - hull[i]).norm();
  }
  return length;
}

}  // namespace palmar::geometry
