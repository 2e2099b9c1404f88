// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/node_compliance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::contact {
namespace {

constexpr int kPatchSize = 32;          // nodes
constexpr double kGaussianRange = 3.0;  // sigma; the weight there is 1 %
constexpr double kNodeSpacing = 1.4;    // sigma; R varies over more than that
constexpr double kLeastMoment = 1e-5;   // share; see node_weights()
constexpr double kMostWeight = 1.7;     // sum of the sizes of the weights of a vertex
constexpr double kSupportRange = 2.6;   // node spacings; some fifteen nodes round a vertex
constexpr double kSupportWidth = 0.85;  // node spacings; of the weights
// Width of S over the mean edge of the elements. Chosen among 0.7, 0.9, 1.1, 1.3 on bonded layers
// of two to four elements: 1.3 is nearest to their closed form.
constexpr double kSigmaPerEdge = 1.3;

using Eigen::Index;
using SparseRow = std::vector<std::pair<int, double>>;  // column, weight

/// Squared width of a vertex' hat function along each axis: edge^2 / 8 on an equilateral lattice.
double hat_width2(const SkinGeometry& skin, int v) {
  return skin.area[v] / (4.0 * std::numbers::sqrt3);
}

/// Rows of W among the vertices of `row_of` (>= 0).
std::vector<SparseRow> gaussian_means(const SkinGeometry& skin, const std::vector<int>& vertex,
                                      const std::vector<double>& sigma,
                                      const std::vector<int>& row_of) {
  std::vector<SparseRow> W(vertex.size());
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const int v = vertex[i];
    const double width2 = sigma[i] * sigma[i] - hat_width2(skin, v);
    const double range = kGaussianRange * std::sqrt(width2);
    double sum = 0.0;
    // Ways along edges are up to a sixth longer than those over the surface.
    for (const GrownVertex& g : grow(skin, std::span(&v, 1), 1.2 * range)) {
      if (row_of[g.vertex] < 0) continue;
      const double r = arc_distance(skin, v, g.vertex);
      if (r > range) continue;
      const double weight = skin.area[g.vertex] * std::exp(-0.5 * r * r / width2);
      W[i].emplace_back(row_of[g.vertex], weight);
      sum += weight;
    }
    for (auto& [column, weight] : W[i]) weight /= sum;
  }
  return W;
}

/// Half-way from each value to the mean over its hat: 3/4, and 1/24 for each of six neighbours.
std::vector<SparseRow> half_hats(const SkinGeometry& skin, const std::vector<int>& vertex,
                                 const std::vector<int>& row_of) {
  std::vector<SparseRow> T(vertex.size());
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const std::span<const int> around = skin.neighbours(vertex[i]);
    double rest = 1.0;
    for (const int w : around) {
      if (row_of[w] < 0) continue;
      const double share = 0.25 / static_cast<double>(around.size());
      T[i].emplace_back(row_of[w], share);
      rest -= share;
    }
    T[i].emplace_back(static_cast<int>(i), rest);
  }
  return T;
}

/// Rows of A B.
std::vector<SparseRow> product(const std::vector<SparseRow>& A, const std::vector<SparseRow>& B) {
  std::vector<SparseRow> result(A.size());
  std::vector<double> sum(A.size(), 0.0);
  std::vector<char> is_met(A.size(), 0);
  std::vector<int> met;
  for (std::size_t i = 0; i < A.size(); ++i) {
    met.clear();
    for (const auto& [k, w] : A[i]) {
      for (const auto& [m, u] : B[k]) {
        if (!is_met[m]) met.push_back(m);
        is_met[m] = 1;
        sum[m] += w * u;
      }
    }
    for (const int k : met) {
      result[i].emplace_back(k, sum[k]);
      sum[k] = 0.0;
      is_met[k] = 0;
    }
  }
  return result;
}

/// Rows of S = 3 W - 3 W T W + W T W T W: by Horner's rule W (3 - 3 T W + T W T W).
std::vector<SparseRow> smoother(const std::vector<SparseRow>& W, const std::vector<SparseRow>& T) {
  const std::vector<SparseRow> TW = product(T, W);
  std::vector<SparseRow> inner = TW;  // 3 - 3 TW + TW TW = 3 + TW (-3 + TW)
  for (std::size_t i = 0; i < inner.size(); ++i) {
    for (auto& [column, value] : inner[i]) {
      if (column == static_cast<int>(i)) value -= 3.0;
    }
  }
  inner = product(TW, inner);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    for (auto& [column, value] : inner[i]) {
      if (column == static_cast<int>(i)) value += 3.0;
    }
  }
  return product(W, inner);
}

/// Weights of nodes at a point, exact for what varies quadratically on the skin (moving least
/// squares in the tangent plane; Lancaster, Salkauskas 1981). With few nodes only for what is even.
std::vector<double> node_weights(const SkinGeometry& skin, int vertex,
                                 const std::vector<int>& nodes, double width) {
  using Basis = Eigen::Matrix<double, 6, 1>;
  const Vec3 n = skin.normal[vertex];
  const Vec3 t = n.unitOrthogonal();
  const Vec3 u = n.cross(t);
  Eigen::Matrix<double, 6, 6> moments = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<Basis> basis;
  std::vector<double> weight;
  double total = 0.0;
  for (const int node : nodes) {
    const Vec3 at = skin.position[node] - skin.position[vertex];
    const double x = at.dot(t) / width;
    const double y = at.dot(u) / width;
    Basis& b = basis.emplace_back();
    b << 1.0, x, y, x * x, x * y, y * y;
    weight.push_back(std::exp(-0.5 * at.squaredNorm() / (width * width)) + 1e-12);
    total += weight.back();
    moments += weight.back() * b * b.transpose();
  }
  // Where nodes don't determine the parabola (at borders, on thin fingers) weights of both signs
  // grow large; the parabola is then held down until they don't.
  std::vector<double> result(nodes.size());
  for (double least = kLeastMoment;; least *= 10.0) {
    Eigen::Matrix<double, 6, 6> held = moments;
    held.diagonal().tail<5>().array() += least * total;
    const Basis first = held.ldlt().solve(Basis::Unit(0));
    double sum = 0.0;
    double size = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      result[k] = weight[k] * basis[k].dot(first);
      sum += result[k];
      size += std::abs(result[k]);
    }
    for (double& w : result) w /= sum;
    if (size < kMostWeight * sum || least > 100.0) return result;
  }
}

void set_nodes(const SkinGeometry& skin, const std::vector<double>& sigma, NodeCompliance& result) {
  std::vector<double> spacing(static_cast<std::size_t>(skin.vertex_count()), 0.0);
  for (std::size_t i = 0; i < result.vertex.size(); ++i) {
    spacing[result.vertex[i]] = kNodeSpacing * sigma[i];
  }
  std::vector<int> node_at(spacing.size(), -1);
  for (const int v : result.vertex) {
    bool is_free = true;
    for (const GrownVertex& g : grow(skin, std::span(&v, 1), spacing[v])) {
      is_free = is_free && node_at[g.vertex] < 0;
    }
    if (!is_free) continue;
    node_at[v] = static_cast<int>(result.node.size());
    result.node.push_back(v);
  }
  result.support_begin.push_back(0);
  for (const int v : result.vertex) {
    std::vector<int> nodes;
    for (const GrownVertex& g : grow(skin, std::span(&v, 1), kSupportRange * spacing[v])) {
      if (node_at[g.vertex] >= 0) nodes.push_back(g.vertex);
    }
    const std::vector<double> weight = node_weights(skin, v, nodes, kSupportWidth * spacing[v]);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (std::abs(weight[k]) < 1e-4) continue;
      result.support.push_back(node_at[nodes[k]]);
      result.weight.push_back(weight[k]);
    }
    result.support_begin.push_back(result.support.size());
  }
}

/// Shares of a vertex' hat among the vertices of the tetrahedra.
std::vector<std::map<int, double>> hat_shares(const SkinGeometry& skin,
                                              const std::vector<Triangle>& triangles,
                                              const HatPoints& points,
                                              const std::vector<hand::SkinAttachment>& attachment) {
  std::vector<std::map<int, double>> share(static_cast<std::size_t>(skin.vertex_count()));
  std::vector<double> area(share.size(), 0.0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < points.share.size(); ++k) {
      const std::size_t q = points.share.size() * t + k;
      for (int c = 0; c < 3; ++c) {
        const int v = triangles[t][c];
        const double own = points.weight[t] * points.share[k][c];
        area[v] += own;
        for (std::size_t a = 0; a < 3; ++a) {
          share[v][attachment[q].vertex[a]] += own * attachment[q].weight[a];
        }
      }
    }
  }
  for (std::size_t v = 0; v < share.size(); ++v) {
    for (auto& [vertex, value] : share[v]) value /= area[v];
  }
  return share;
}

/// Three loads per node: S of the hats, along x, y, z.
std::vector<SurfaceLoad> node_loads(const NodeCompliance& layout, const std::vector<SparseRow>& S,
                                    const std::vector<int>& row_of,
                                    const std::vector<std::map<int, double>>& hat) {
  std::vector<SurfaceLoad> loads;
  for (const int node : layout.node) {
    std::map<int, double> sum;
    for (const auto& [row, weight] : S[row_of[node]]) {
      for (const auto& [v, share] : hat[layout.vertex[row]]) sum[v] += weight * share;
    }
    for (int k = 0; k < 3; ++k) {
      SurfaceLoad& load = loads.emplace_back();
      for (const auto& [v, share] : sum) {
        if (std::abs(share) < 1e-5) continue;
        load.vertex.push_back(v);
        load.force.emplace_back(share * Vec3::Unit(k));
      }
    }
  }
  return loads;
}

}  // namespace

double smoothing_width(const SkinGeometry& skin, int vertex, double edge) {
  const double resolved = kSigmaPerEdge * edge;
  // A Gaussian narrower than 0.8 edges of the skin is no Gaussian on its vertices.
  return std::sqrt(
      std::max(resolved * resolved, hat_width2(skin, vertex) + 0.55 * skin.area[vertex]));
}

int divisions_for(double skin_edge, double element_edge) {
  return std::clamp(static_cast<int>(std::ceil(2.0 * skin_edge / element_edge)), 2, 8);
}

HatPoints hat_points(const SkinGeometry& skin, const std::vector<Triangle>& triangles,
                     int divisions) {
  HatPoints result;
  for (int i = 0; i < divisions; ++i) {
    for (int j = 0; i + j < divisions; ++j) {
      result.share.emplace_back(0.0, i + 1.0 / 3.0, j + 1.0 / 3.0);
      if (i + j + 1 < divisions) result.share.emplace_back(0.0, i + 2.0 / 3.0, j + 2.0 / 3.0);
    }
  }
  for (Vec3& share : result.share) {
    share /= divisions;
    share[0] = 1.0 - share[1] - share[2];
  }
  for (const Triangle& t : triangles) {
    for (const Vec3& share : result.share) {
      result.point.emplace_back(share[0] * skin.position[t[0]] + share[1] * skin.position[t[1]] +
                                share[2] * skin.position[t[2]]);
    }
    result.weight.push_back(
        geometry::triangle_area(skin.position[t[0]], skin.position[t[1]], skin.position[t[2]]) /
        static_cast<double>(result.share.size()));
  }
  return result;
}

NodeCompliance node_compliance(const SkinGeometry& skin, const std::vector<Triangle>& triangles,
                               const ElasticBody& body, const std::vector<int>& vertex,
                               const std::vector<double>& sigma) {
  NodeCompliance result;
  result.vertex = vertex;
  result.sigma = sigma;
  std::vector<int> row_of(static_cast<std::size_t>(skin.vertex_count()), -1);
  for (std::size_t i = 0; i < vertex.size(); ++i) row_of[vertex[i]] = static_cast<int>(i);
  set_nodes(skin, sigma, result);
  const std::vector<SparseRow> W = gaussian_means(skin, vertex, sigma, row_of);
  const std::vector<SparseRow> S = smoother(W, half_hats(skin, vertex, row_of));
  const std::vector<SurfaceLoad> loads =
      node_loads(result, S, row_of, hat_shares(skin, triangles, *body.points, body.attachment));

  std::vector<Vec3> points;
  for (const int v : result.node) points.push_back(skin.position[v]);
  int count = 0;
  const std::vector<int> patch = compact_patches(points, kPatchSize, count);
  std::vector<int> patch_of_load;
  for (const int p : patch) patch_of_load.insert(patch_of_load.end(), 3, p);
  std::vector<std::vector<int>> near(static_cast<std::size_t>(count));
  for (int I = 0; I < count; ++I) {
    near[I].resize(static_cast<std::size_t>(I) + 1);
    std::iota(near[I].begin(), near[I].end(), 0);
  }
  result.smooth = PatchMatrix(std::move(patch_of_load), count, std::move(near));
  surface_compliance(*body.mesh, *body.is_held, loads, {.poisson = 0.5}, result.smooth);
  return result;
}

std::vector<int> compact_patches(const std::vector<Vec3>& points, int size, int& count) {
  std::vector<int> patch(points.size(), 0);
  count = 0;
  std::vector<std::vector<int>> todo(1);
  for (std::size_t i = 0; i < points.size(); ++i) todo[0].push_back(static_cast<int>(i));
  if (points.empty()) return patch;
  while (!todo.empty()) {
    std::vector<int> part = std::move(todo.back());
    todo.pop_back();
    if (static_cast<int>(part.size()) <= size) {
      for (const int i : part) patch[i] = count;
      ++count;
      continue;
    }
    Box3 box;
    for (const int i : part) box.extend(points[i]);
    Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(), [&](int a, int b) {
      return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
    });
    todo.emplace_back(middle, part.end());
    todo.emplace_back(part.begin(), middle);
  }
  return patch;
}

}  // namespace palmar::contact
