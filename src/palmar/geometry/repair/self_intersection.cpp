// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/self_intersection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/triangle_partition.h"

namespace palmar::geometry {
namespace {

using Corners = std::array<Vec3, 3>;

// Six times the volume of a tetrahedron, 0 within rounding: then d counts as in the plane a b c,
// and a touch isn't a crossing.
double side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double volume = u.cross(v).dot(w);
  const double noise = 1e-14 * u.norm() * v.norm() * w.norm();
  return std::abs(volume) <= noise ? 0.0 : volume;
}

// Whether the segment p q goes through the triangle's inside.
bool pierces(const Vec3& p, const Vec3& q, const Corners& t) {
  const double sp = side(t[0], t[1], t[2], p), sq = side(t[0], t[1], t[2], q);
  if (!(sp * sq < 0.0)) return false;
  const double a = side(p, q, t[0], t[1]), b = side(p, q, t[1], t[2]), c = side(p, q, t[2], t[0]);
  // A line through an edge of the triangle counts: else two edges that meet exactly would hide
  // a crossing from both sides.
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

bool is_on_one_side(const Corners& plane, const Corners& t) {
  const double a = side(plane[0], plane[1], plane[2], t[0]);
  const double b = side(plane[0], plane[1], plane[2], t[1]);
  const double c = side(plane[0], plane[1], plane[2], t[2]);
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

bool do_cross(const Corners& s, const Corners& t, int shared_count, size_t shared_s,
              size_t shared_t) {
  if (shared_count >= 2) return false;
  if (shared_count == 1) {
    return pierces(s[(shared_s + 1) % 3], s[(shared_s + 2) % 3], t) ||
           pierces(t[(shared_t + 1) % 3], t[(shared_t + 2) % 3], s);
  }
  if (is_on_one_side(s, t) || is_on_one_side(t, s)) return false;
  for (size_t k = 0; k < 3; ++k) {
    if (pierces(s[k], s[(k + 1) % 3], t) || pierces(t[k], t[(k + 1) % 3], s)) return true;
  }
  return false;
}

// Pairs of triangles whose boxes overlap, each once, by a walk down the partition against itself.
class BoxTree {
 public:
  explicit BoxTree(const TriangleMesh& mesh) : partition_(partition_triangles(mesh, kLeaf)) {
    triangle_box_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      Box3 box;
      for (const int v : t) box.extend(mesh.vertices[v]);
      triangle_box_.push_back(box);
    }
    node_box_.resize(partition_.nodes.size());
    for (size_t n = partition_.nodes.size(); n-- > 0;) {
      const auto& node = partition_.nodes[n];
      for (size_t k = 0; k < kWidth; ++k) {
        Box3& box = node_box_[n][k];
        if (node.child[k] >= 0) {
          for (const Box3& part : node_box_[node.child[k]]) box.extend(part);
          continue;
        }
        for (int i = node.begin[k]; i < node.end[k]; ++i) box.extend(triangle_box_[at(i)]);
      }
    }
  }

  template <typename Visit>
  void for_each_pair(const Visit& visit) const {
    if (!partition_.nodes.empty()) within(0, visit);
  }

 private:
  static constexpr size_t kWidth = TrianglePartition::kWidth;
  static constexpr int kLeaf = 4;

  struct Part {
    size_t node, k;
  };

  size_t at(int i) const { return static_cast<std::size_t>(partition_.order[i]); }
  const Box3& box(const Part& p) const { return node_box_[p.node][p.k]; }
  const TrianglePartition::Node& node(const Part& p) const { return partition_.nodes[p.node]; }
  int child(const Part& p) const { return node(p).child[p.k]; }

  template <typename Visit>
  void try_pair(int i, int j, const Visit& visit) const {
    if (triangle_box_[at(i)].intersects(triangle_box_[at(j)])) {
      visit(static_cast<int>(at(i)), static_cast<int>(at(j)));
    }
  }

  template <typename Visit>
  void within(size_t n, const Visit& visit) const {
    const auto& node = partition_.nodes[n];
    for (size_t k = 0; k < kWidth; ++k) {
      if (node.child[k] >= 0) {
        within(node.child[k], visit);
      } else {
        for (int i = node.begin[k]; i < node.end[k]; ++i) {
          for (int j = i + 1; j < node.end[k]; ++j) try_pair(i, j, visit);
        }
      }
      for (size_t l = k + 1; l < kWidth; ++l) between({n, k}, {n, l}, visit);
    }
  }

  template <typename Visit>
  void between(const Part& p, const Part& q, const Visit& visit) const {
    if (!box(p).intersects(box(q))) return;
    if (child(p) < 0 && child(q) < 0) {
      for (int i = node(p).begin[p.k]; i < node(p).end[p.k]; ++i) {
        if (!triangle_box_[at(i)].intersects(box(q))) continue;
        for (int j = node(q).begin[q.k]; j < node(q).end[q.k]; ++j) try_pair(i, j, visit);
      }
      return;
    }
    // Open the larger of the two.
    const bool opens_p = child(q) < 0 || (child(p) >= 0 && node(p).size(static_cast<int>(p.k)) >=
                                                               node(q).size(static_cast<int>(q.k)));
    const Part& opened = opens_p ? p : q;
    const Part& other = opens_p ? q : p;
    for (size_t k = 0; k < kWidth; ++k) {
      between({static_cast<std::size_t>(child(opened)), k}, other, visit);
    }
  }

  TrianglePartition partition_;
  std::vector<Box3> triangle_box_;
  std::vector<std::array<Box3, TrianglePartition::kWidth>> node_box_;
};

Corners corners_of(const TriangleMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

// Patch number of every vertex marked inside: connected over edges; -1 for the others.
std::vector<int> number_patches(const MeshTopology& topology, const std::vector<bool>& is_inside) {
  const auto neighbours = vertex_neighbours(topology);
  std::vector<int> patch(is_inside.size(), -1), front;
  int count = 0;
  for (size_t seed = 0; seed < is_inside.size(); ++seed) {
    if (!is_inside[seed] || patch[seed] >= 0) continue;
    front.assign(1, static_cast<int>(seed));
    patch[seed] = count;
    while (!front.empty()) {
      const int v = front.back();
      front.pop_back();
      for (const int n : neighbours[v]) {
        if (!is_inside[n] || patch[n] >= 0) continue;
        patch[n] = count;
        front.push_back(n);
      }
    }
    ++count;
  }
  return patch;
}

// Length of the ray from p along the unit vector d to the triangle; infinity if it misses.
// Source: Moeller, Trumbore 1997.
double ray_length(const Vec3& p, const Vec3& d, const Corners& t) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0];
  const double det = e1.dot(d.cross(e2));
  if (det == 0.0) return kMiss;
  const Vec3 s = p - t[0];
  const double u = s.dot(d.cross(e2)) / det, v = d.dot(s.cross(e1)) / det;
  const double length = e2.dot(s.cross(e1)) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && length >= 0.0 ? length : kMiss;
}

// A triangle at the skin of an overlap.
struct Cover {
  Triangle vertices;
  Corners corners;
  int patch;  // of its inside corners; -1 if it has none
};

std::vector<Cover> collect_covers(const TriangleMesh& mesh,
                                  const std::vector<std::array<int, 2>>& pairs,
                                  const std::vector<int>& patch) {
  std::vector<bool> crosses(mesh.triangles.size(), false);
  for (const auto& [i, j] : pairs) {
    crosses[i] = crosses[j] = true;
  }
  std::vector<Cover> covers;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    int own = -1;
    for (const int v : mesh.triangles[t]) own = std::max(own, patch[v]);
    if (own < 0 && !crosses[t]) continue;
    covers.push_back({mesh.triangles[t], corners_of(mesh, static_cast<int>(t)), own});
  }
  return covers;
}

}  // namespace

bool do_triangles_cross(const Corners& first, const Corners& second) {
  int shared = 0;
  size_t shared_first = 0, shared_second = 0;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      if (first[i] != second[j]) continue;
      ++shared;
      shared_first = i;
      shared_second = j;
    }
  }
  return do_cross(first, second, shared, shared_first, shared_second);
}

std::vector<std::array<int, 2>> find_self_crossings(const TriangleMesh& mesh) {
  check_finite_and_indexed(mesh);
  std::vector<std::array<int, 2>> pairs;
  BoxTree(mesh).for_each_pair([&](int i, int j) {
    const Triangle& s = mesh.triangles[i];
    const Triangle& t = mesh.triangles[j];
    int shared = 0;
    size_t shared_s = 0, shared_t = 0;
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b < 3; ++b) {
        if (s[a] != t[b]) continue;
        ++shared;
        shared_s = a;
        shared_t = b;
      }
    }
    if (shared >= 2) return;
    if (do_cross(corners_of(mesh, i), corners_of(mesh, j), shared, shared_s, shared_t)) {
      pairs.push_back({std::min(i, j), std::max(i, j)});
    }
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

CrossingDepth crossing_depth(const TriangleMesh& mesh) {
  require_closed_manifold(mesh, "self-crossing depth");
  CrossingDepth result;
  result.pairs = find_self_crossings(mesh);
  if (result.pairs.empty()) return result;

  const MeshTopology topology = build_topology(mesh);
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const WindingNumber winding(mesh);
  // Just outside: far below an edge, far above rounding.
  const double offset = 1e-4 * edge_lengths(mesh).mean;
  std::vector<bool> is_inside(mesh.vertices.size(), false);
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    is_inside[v] = winding.at(mesh.vertices[v] + offset * normals[v]) > 0.5;
  }
  const std::vector<int> patch = number_patches(topology, is_inside);
  const std::vector<Cover> covers = collect_covers(mesh, result.pairs, patch);

  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_inside[v]) continue;
    double depth = std::numeric_limits<double>::infinity();
    for (const Cover& cover : covers) {
      if (std::find(cover.vertices.begin(), cover.vertices.end(), static_cast<int>(v)) !=
          cover.vertices.end()) {
        continue;
      }
      depth = std::min(depth, ray_length(mesh.vertices[v], -normals[v], cover.corners));
      if (cover.patch == patch[v]) continue;
      const TrianglePoint foot = closest_point_on_triangle(mesh.vertices[v], cover.corners[0],
                                                           cover.corners[1], cover.corners[2]);
      depth = std::min(depth, std::sqrt(foot.squared_distance));
    }
    if (!std::isfinite(depth)) continue;
    result.vertex.push_back(static_cast<int>(v));
    result.depth.push_back(depth);
    result.deepest = std::max(result.deepest, result.depth.back());
  }
  return result;
}

}  // namespace palmar::geometry
