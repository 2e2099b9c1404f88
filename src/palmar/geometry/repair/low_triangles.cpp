// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/low_triangles.h"

#include <algorithm>
#include <array>

#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

constexpr int kMaxRounds = 20;

double height_of(const TriangleMesh& mesh, const Triangle& t) {
  return least_height(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
}

Vec3 centre_of(const TriangleMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
}

/// Corner of a triangle at which its longest edge starts.
int longest_edge(const TriangleMesh& mesh, const Triangle& t) {
  int best = 0;
  double longest = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double length = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm();
    if (length > longest) {
      longest = length;
      best = k;
    }
  }
  return best;
}

/// One round over all low triangles; whether anything changed.
bool repair_round(TriangleMesh& mesh, double height, std::vector<Vec3>& places) {
  const MeshTopology topology = build_topology(mesh);
  std::vector<bool> is_touched(mesh.vertices.size(), false);
  std::vector<bool> is_dropped(mesh.triangles.size(), false);
  bool has_changed = false;
  const auto are_neighbours = [&](int a, int b) {
    return std::binary_search(topology.edge.begin(), topology.edge.end(),
                              std::array<int, 2>{std::min(a, b), std::max(a, b)});
  };
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle low = mesh.triangles[t];
    const double low_height = height_of(mesh, low);
    if (low_height > height) continue;
    const int k = longest_edge(mesh, low);
    const int h = 3 * t + k;
    const int a = low[k], b = low[(k + 1) % 3], c = low[(k + 2) % 3];
    if (topology.edge_of[h] < 0 || is_touched[a] || is_touched[b] || is_touched[c]) continue;
    if (topology.edge_use[topology.edge_of[h]] == 1) {
      is_dropped[t] = true;
      for (const int v : low) is_touched[v] = true;
      places.push_back(centre_of(mesh, low));
      has_changed = true;
      continue;
    }
    const int g = topology.twin[h];
    if (g < 0 || mesh.triangles[g / 3][g % 3] != b) continue;
    const int d = mesh.triangles[g / 3][MeshTopology::previous(g) % 3];
    if (d == c || is_touched[d] || are_neighbours(c, d)) continue;
    const Triangle first = {a, d, c}, second = {d, b, c};
    if (std::min(height_of(mesh, first), height_of(mesh, second)) <= low_height) continue;
    mesh.triangles[t] = first;
    mesh.triangles[g / 3] = second;
    for (const int v : {a, b, c, d}) is_touched[v] = true;
    places.push_back(centre_of(mesh, low));
    has_changed = true;
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_dropped[t]) mesh.triangles[kept++] = mesh.triangles[t];
  }
  mesh.triangles.resize(kept);
  return has_changed;
}

}  // namespace

double least_height(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return longest > 0.0 ? (b - a).cross(c - a).norm() / longest : 0.0;
}

LowTrianglesResult repair_low_triangles(const TriangleMesh& mesh, double height) {
  LowTrianglesResult result{mesh, {}, {}};
  const auto is_low = [&](const Triangle& t) { return height_of(result.mesh, t) <= height; };
  for (int round = 0; round < kMaxRounds; ++round) {
    if (std::none_of(result.mesh.triangles.begin(), result.mesh.triangles.end(), is_low)) break;
    if (!repair_round(result.mesh, height, result.places)) break;
  }
  for (const Triangle& t : result.mesh.triangles) {
    if (is_low(t)) result.left.push_back(centre_of(result.mesh, t));
  }
  return result;
}

}  // namespace palmar::geometry
