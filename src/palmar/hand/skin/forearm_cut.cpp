// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/forearm_cut.h"

#include <Eigen/Dense>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace palmar::hand {
namespace {

bool faces_the_forearm(const geometry::TriangleMesh& skin, const Triangle& t) {
  const Vec3 &a = skin.vertices[t[0]], &b = skin.vertices[t[1]], &c = skin.vertices[t[2]];
  const Vec3 normal = (b - a).cross(c - a).normalized();
  return normal.y() < -0.6 && (a.y() + b.y() + c.y()) / 3 < 0;
}

/// Border of the triangles, once round as they run; empty unless it is one loop.
std::vector<int> border_loop(const std::vector<Triangle>& triangles) {
  std::set<std::pair<int, int>> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
  }
  std::map<int, int> next;
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) > 0) continue;
    if (!next.emplace(a, b).second) return {};
  }
  if (next.empty()) return {};
  std::vector<int> loop = {next.begin()->first};
  for (int v = next.begin()->second; v != loop.front(); v = next.at(v)) {
    loop.push_back(v);
    if (loop.size() > next.size()) return {};
  }
  return loop.size() == next.size() ? loop : std::vector<int>{};
}

/// y over (x, z), least squares.
void flatten(geometry::TriangleMesh& skin, const std::vector<int>& rim) {
  Eigen::MatrixX3d place(rim.size(), 3);
  Eigen::VectorXd y(rim.size());
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3& v = skin.vertices[rim[i]];
    place.row(static_cast<Eigen::Index>(i)) << v.x(), v.z(), 1.0;
    y[static_cast<Eigen::Index>(i)] = v.y();
  }
  const Vec3 plane = place.colPivHouseholderQr().solve(y);
  for (const int v : rim) {
    Vec3& p = skin.vertices[v];
    p.y() = plane.x() * p.x() + plane.y() * p.z() + plane.z();
  }
}

}  // namespace

geometry::TriangleMesh with_even_cut(const geometry::TriangleMesh& skin_in_hand) {
  constexpr double kRings[] = {0.55};  // of the way from the middle to the rim
  geometry::TriangleMesh skin;
  skin.vertices = skin_in_hand.vertices;
  std::vector<Triangle> cut;
  for (const Triangle& t : skin_in_hand.triangles) {
    (faces_the_forearm(skin_in_hand, t) ? cut : skin.triangles).push_back(t);
  }
  const std::vector<int> rim = border_loop(cut);
  std::set<int> inside;
  for (const Triangle& t : cut) inside.insert(t.begin(), t.end());
  if (rim.size() < 6 || inside.size() != rim.size()) return skin_in_hand;

  flatten(skin, rim);
  Vec3 middle = Vec3::Zero();
  for (const int v : rim) middle += skin.vertices[v] / static_cast<double>(rim.size());
  std::vector<int> outer = rim;
  for (const double share : kRings) {
    std::vector<int> inner;
    for (const int v : rim) {
      inner.push_back(static_cast<int>(skin.vertices.size()));
      skin.vertices.push_back(middle + share * (skin.vertices[v] - middle));
    }
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const std::size_t j = (i + 1) % rim.size();
      skin.triangles.push_back({outer[i], outer[j], inner[j]});
      skin.triangles.push_back({outer[i], inner[j], inner[i]});
    }
    outer = inner;
  }
  const int centre = static_cast<int>(skin.vertices.size());
  skin.vertices.push_back(middle);
  for (std::size_t i = 0; i < outer.size(); ++i) {
    skin.triangles.push_back({outer[i], outer[(i + 1) % outer.size()], centre});
  }
  return skin;
}

}  // namespace palmar::hand
