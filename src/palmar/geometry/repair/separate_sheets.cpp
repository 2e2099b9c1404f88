// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/separate_sheets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

constexpr double kSameAngle = 1e-4;  // rad: sheets that lie on each other have no wedge between

class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

/// A triangle at an edge, seen along the edge.
struct Leaf {
  double angle;
  int half_edge;
  bool is_forward;  ///< runs from the edge's first to its second end: its material lies clockwise
};

/// Pairs of half-edges round an edge that bound one wedge of material each; empty if unclear.
std::vector<std::array<int, 2>> pair_leaves(const TriangleMesh& mesh,
                                            const std::array<int, 2>& edge,
                                            const std::vector<int>& half_edges) {
  if (half_edges.size() % 2 != 0) return {};
  const Vec3& a = mesh.vertices[edge[0]];
  const Vec3 along = mesh.vertices[edge[1]] - a;
  if (!(along.norm() > 0.0)) return {};
  const Vec3 w = along.normalized(), u = w.unitOrthogonal(), v = w.cross(u);
  std::vector<Leaf> leaves;
  for (const int h : half_edges) {
    const Triangle& t = mesh.triangles[h / 3];
    const Vec3 apex = mesh.vertices[t[MeshTopology::previous(h) % 3]] - a;
    leaves.push_back({std::atan2(v.dot(apex), u.dot(apex)), h, t[h % 3] == edge[0]});
  }
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& x, const Leaf& y) {
    return x.angle != y.angle ? x.angle < y.angle : x.half_edge < y.half_edge;
  });
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf& next = leaves[(i + 1) % leaves.size()];
    const double step =
        next.angle - leaves[i].angle + (i + 1 == leaves.size() ? 2.0 * std::numbers::pi : 0.0);
    if (next.is_forward == leaves[i].is_forward || step < kSameAngle) return {};
    if (!leaves[i].is_forward) pairs.push_back({leaves[i].half_edge, next.half_edge});
  }
  return pairs;
}

/// Joins the corners at both ends of two triangles that are neighbours over an edge.
void join(const TriangleMesh& mesh, int h, int g, Sets& fans) {
  const auto start = [&](int x) { return mesh.triangles[x / 3][x % 3]; };
  const bool is_opposite = start(h) != start(g);
  fans.unite(h, is_opposite ? MeshTopology::next(g) : g);
  fans.unite(MeshTopology::next(h), is_opposite ? g : MeshTopology::next(g));
}

}  // namespace

SeparatedSheets separate_touching_sheets(const TriangleMesh& mesh, double gap) {
  SeparatedSheets result;
  result.mesh = mesh;
  const MeshTopology topology = build_topology(mesh);
  const int half_edges = 3 * mesh.triangle_count();
  std::vector<std::vector<int>> leaves(topology.edge.size());
  Sets fans(half_edges);
  std::vector<int> free_corner(mesh.vertices.size(), -1);
  for (int h = 0; h < half_edges; ++h) {
    const int edge = topology.edge_of[h];
    if (edge < 0) continue;
    if (topology.twin[h] > h) join(mesh, h, topology.twin[h], fans);
    if (topology.edge_use[edge] > 2) leaves[edge].push_back(h);
    if (topology.edge_use[edge] != 1) continue;
    // Open fans at a corner stay together: they belong to holes.
    for (const int corner : {h, MeshTopology::next(h)}) {
      int& first = free_corner[mesh.triangles[corner / 3][corner % 3]];
      if (first >= 0) fans.unite(first, corner);
      first = corner;
    }
  }
  for (std::size_t e = 0; e < leaves.size(); ++e) {
    if (leaves[e].empty()) continue;
    const auto pairs = pair_leaves(mesh, topology.edge[e], leaves[e]);
    const Vec3 middle =
        (mesh.vertices[topology.edge[e][0]] + mesh.vertices[topology.edge[e][1]]) / 2.0;
    (pairs.empty() ? result.left_edges : result.separated_edges).push_back(middle);
    for (const auto& pair : pairs) join(mesh, pair[0], pair[1], fans);
    if (!pairs.empty()) continue;
    for (const int h : leaves[e]) join(mesh, leaves[e].front(), h, fans);
  }

  std::vector<int> corners;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto around = topology.outgoing(v);
    if (around.size() < 2) continue;
    corners.assign(around.begin(), around.end());
    std::stable_sort(corners.begin(), corners.end(),
                     [&](int x, int y) { return fans.root(x) < fans.root(y); });
    std::vector<std::vector<int>> groups;
    for (const int corner : corners) {
      if (groups.empty() || fans.root(groups.back().front()) != fans.root(corner)) {
        groups.emplace_back();
      }
      groups.back().push_back(corner);
    }
    if (groups.size() < 2) continue;
    result.doubled.push_back(mesh.vertices[v]);
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& x, const auto& y) { return x.size() > y.size(); });
    for (std::size_t i = 1; i < groups.size(); ++i) {
      const Vec3& x = mesh.vertices[v];
      Vec3 inward = Vec3::Zero(), normal = Vec3::Zero();
      double reach = 0.0;
      for (const int corner : groups[i]) {
        const Triangle& t = mesh.triangles[corner / 3];
        const Vec3 b = mesh.vertices[t[MeshTopology::next(corner) % 3]] - x;
        const Vec3 c = mesh.vertices[t[MeshTopology::previous(corner) % 3]] - x;
        inward += b + c;
        normal += b.cross(c);
        reach += b.norm() + c.norm();
      }
      if (!(inward.norm() > 0.1 * reach)) inward = -normal;
      if (inward.norm() > 0.0) inward.normalize();
      for (const int corner : groups[i]) {
        result.mesh.triangles[corner / 3][corner % 3] = result.mesh.vertex_count();
      }
      result.mesh.vertices.push_back(x + gap * static_cast<double>(i) * inward);
    }
  }
  return result;
}

}  // namespace palmar::geometry
