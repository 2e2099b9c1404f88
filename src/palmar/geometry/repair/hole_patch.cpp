// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/hole_patch.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/geometry/mesh/editable_mesh.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

constexpr int kMostExactCorners = 200;
constexpr int kMostCorners = 2000;
constexpr int kMostSearches = 50;  // for ears that a corner cut off has made free
constexpr int kMostNewVertices = 20'000;
constexpr double kEdgeShare = 1e-3;  // of squared edges to areas: chooses among flat triangulations
constexpr double kLongEdge = 4.0 / 3.0;  // of the rim's mean
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Best triangulation of the corners i..k of a ring for all i < k, by dynamic programming.
class LeastArea {
 public:
  LeastArea(const std::vector<Vec3>& ring, const IsJoined& is_joined)
      : ring_(ring), n_(static_cast<int>(ring.size())) {
    cost_.assign(static_cast<std::size_t>(n_) * n_, 0.0);
    apex_.assign(static_cast<std::size_t>(n_) * n_, -1);
    for (int span = 2; span < n_; ++span) {
      for (int i = 0; i + span < n_; ++i) {
        const int k = i + span;
        double& best = cost_[at(i, k)];
        best = kInfinite;
        if (span < n_ - 1 && is_joined(i, k)) continue;
        const double edge = kEdgeShare * (ring[k] - ring[i]).squaredNorm();
        for (int j = i + 1; j < k; ++j) {
          const double rest = cost_[at(i, j)] + cost_[at(j, k)];
          if (!(rest < best)) continue;
          const double sum = rest + edge + triangle_area(ring[i], ring[j], ring[k]);
          if (sum < best) {
            best = sum;
            apex_[at(i, k)] = j;
          }
        }
      }
    }
  }
  std::optional<TriangleMesh> result() const {
    if (!std::isfinite(cost_[at(0, n_ - 1)])) return std::nullopt;
    TriangleMesh mesh{ring_, {}};
    std::vector<std::array<int, 2>> open = {{0, n_ - 1}};
    while (!open.empty()) {
      const auto [i, k] = open.back();
      open.pop_back();
      if (k - i < 2) continue;
      const int j = apex_[at(i, k)];
      mesh.triangles.push_back({i, j, k});
      open.push_back({j, k});
      open.push_back({i, j});
    }
    return mesh;
  }

 private:
  std::size_t at(int i, int k) const { return static_cast<std::size_t>(i) * n_ + k; }
  const std::vector<Vec3>& ring_;
  int n_;
  std::vector<double> cost_;
  std::vector<int> apex_;
};

/// Ear by ear for long rings: the ear with the least angle in the plane of the ring that holds no
/// other corner.
std::optional<TriangleMesh> cut_ears(const std::vector<Vec3>& ring, const IsJoined& is_joined) {
  const int n = static_cast<int>(ring.size());
  Vec3 normal = Vec3::Zero();
  for (int i = 0; i < n; ++i) {
    normal += (ring[i] - ring[0]).cross(ring[(i + 1) % n] - ring[0]);
  }
  if (!(normal.norm() > 0.0)) return std::nullopt;
  normal.normalize();
  const auto turn = [&](int a, int b, int c) {
    return (ring[b] - ring[a]).cross(ring[c] - ring[b]).dot(normal);
  };
  std::vector<int> before(ring.size()), after(ring.size());
  for (int i = 0; i < n; ++i) {
    before[i] = (i + n - 1) % n;
    after[i] = (i + 1) % n;
  }
  const auto angle = [&](int tip) {
    const int a = before[tip], c = after[tip];
    if (!(turn(a, tip, c) > 0.0) || is_joined(a, c)) return kInfinite;
    for (int p = after[c]; p != a; p = after[p]) {
      if (turn(a, tip, p) >= 0.0 && turn(tip, c, p) >= 0.0 && turn(c, a, p) >= 0.0) {
        return kInfinite;
      }
    }
    const Vec3 u = ring[a] - ring[tip], v = ring[c] - ring[tip];
    return std::atan2(u.cross(v).norm(), u.dot(v));
  };
  std::vector<double> angles(ring.size());
  for (int i = 0; i < n; ++i) angles[i] = angle(i);
  TriangleMesh mesh{ring, {}};
  int start = 0;
  int searches = 0;
  for (int left = n; left > 3;) {
    int best = -1;
    for (int i = start, k = 0; k < left; ++k, i = after[i]) {
      if (std::isfinite(angles[i]) && (best < 0 || angles[i] < angles[best])) best = i;
    }
    if (best < 0) {
      if (++searches > kMostSearches) return std::nullopt;
      bool has_ear = false;
      for (int i = start, k = 0; k < left; ++k, i = after[i]) {
        angles[i] = angle(i);
        has_ear |= std::isfinite(angles[i]);
      }
      if (!has_ear) return std::nullopt;
      continue;
    }
    --left;
    const int a = before[best], c = after[best];
    mesh.triangles.push_back({a, best, c});
    after[a] = c;
    before[c] = a;
    start = a;
    angles[a] = angle(a);
    angles[c] = angle(c);
  }
  mesh.triangles.push_back({before[start], start, after[start]});
  return mesh;
}

double mean_ring_edge(const TriangleMesh& patch, int ring_size) {
  double sum = 0.0;
  for (int i = 0; i < ring_size; ++i) {
    sum += (patch.vertices[(i + 1) % ring_size] - patch.vertices[i]).norm();
  }
  return sum / ring_size;
}

/// Turns inner edges until no angle pair opposite to one exceeds 180 degrees.
void turn_edges(EditableMesh& mesh, int ring_size, const IsJoined& is_joined) {
  const auto angle_at = [&](int h) {
    const Vec3& tip = mesh.position(mesh.apex(h));
    const Vec3 u = mesh.position(mesh.start(h)) - tip, v = mesh.position(mesh.end(h)) - tip;
    return std::atan2(u.cross(v).norm(), u.dot(v));
  };
  const auto normal = [&](int a, int b, int c) {
    return Vec3((mesh.position(b) - mesh.position(a)).cross(mesh.position(c) - mesh.position(a)));
  };
  for (int round = 0; round < 20; ++round) {
    int turned = 0;
    for (int h = 0; h < mesh.half_edge_capacity(); ++h) {
      if (!mesh.has_half_edge(h) || mesh.twin(h) < h) continue;
      if (angle_at(h) + angle_at(mesh.twin(h)) <= M_PI + 1e-9) continue;
      const int a = mesh.start(h), b = mesh.end(h), c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
      if (c < ring_size && d < ring_size && is_joined(c, d)) continue;
      // No fold: both new triangles face as the old ones together.
      const Vec3 old_normal = normal(a, b, c) + normal(b, a, d);
      if (normal(a, d, c).dot(old_normal) <= 0.0 || normal(d, b, c).dot(old_normal) <= 0.0) {
        continue;
      }
      if (mesh.flip(h)) ++turned;
    }
    if (turned == 0) return;
  }
}

}  // namespace

std::optional<TriangleMesh> triangulate_ring(const std::vector<Vec3>& ring,
                                             const IsJoined& is_joined) {
  const int corners = static_cast<int>(ring.size());
  if (corners < 3 || corners > kMostCorners) return std::nullopt;
  if (corners > kMostExactCorners) return cut_ears(ring, is_joined);
  return LeastArea(ring, is_joined).result();
}

TriangleMesh refine_patch(const TriangleMesh& patch, int ring_size, const IsJoined& is_joined) {
  EditableMesh mesh(patch);
  const double wanted = mean_ring_edge(patch, ring_size);
  turn_edges(mesh, ring_size, is_joined);
  for (int round = 0; round < 12; ++round) {
    int split = 0;
    const int edges = mesh.half_edge_capacity();
    for (int h = 0; h < edges; ++h) {
      if (!mesh.has_half_edge(h) || mesh.twin(h) < h) continue;
      const Vec3 a = mesh.position(mesh.start(h)), b = mesh.position(mesh.end(h));
      if ((b - a).norm() <= kLongEdge * wanted) continue;
      if (mesh.vertex_capacity() >= ring_size + kMostNewVertices) break;
      mesh.split(h, (a + b) / 2.0);
      ++split;
    }
    if (split == 0) break;
    turn_edges(mesh, ring_size, is_joined);
  }
  return mesh.compacted().mesh;
}

TriangleMesh fair_patch(const TriangleMesh& patch, const std::vector<std::vector<Vec3>>& beyond) {
  const int ring_size = static_cast<int>(beyond.size());
  const int inner = patch.vertex_count() - ring_size;
  if (inner <= 0) return patch;
  const auto neighbours = vertex_neighbours(build_topology(patch));
  // Per vertex v a row: sum_j w_j (x_j - x_v), scaled so that its own weight is 1.
  using Sparse = Eigen::SparseMatrix<double>;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(patch.vertex_count(), 3);
  for (int v = 0; v < patch.vertex_count(); ++v) {
    const Vec3& x = patch.vertices[v];
    // Within, equal weights spread the vertices evenly; round the rim edges have any length.
    const auto weight = [&](const Vec3& y) {
      return v >= ring_size ? 1.0 : 1.0 / std::max((y - x).norm(), 1e-9);
    };
    double sum = 0.0;
    for (const int j : neighbours[v]) sum += weight(patch.vertices[j]);
    if (v < ring_size) {
      for (const Vec3& y : beyond[v]) sum += weight(y);
    }
    const auto add = [&](int j, double w) {
      if (j >= ring_size) {
        entries.emplace_back(v, j - ring_size, w);
      } else {
        right.row(v) -= w * patch.vertices[j].transpose();
      }
    };
    add(v, -1.0);
    for (const int j : neighbours[v]) add(j, weight(patch.vertices[j]) / sum);
    if (v < ring_size) {
      for (const Vec3& y : beyond[v]) right.row(v) -= weight(y) / sum * y.transpose();
    }
  }
  Sparse matrix(patch.vertex_count(), inner);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Sparse normal_matrix = matrix.transpose() * matrix;
  const Eigen::SimplicialLDLT<Sparse> solver(normal_matrix);
  if (solver.info() != Eigen::Success) return patch;
  const Eigen::MatrixX3d x = solver.solve(matrix.transpose() * right);
  if (!x.allFinite()) return patch;
  TriangleMesh result = patch;
  for (int i = 0; i < inner; ++i) result.vertices[ring_size + i] = x.row(i).transpose();
  return result;
}

}  // namespace palmar::geometry
