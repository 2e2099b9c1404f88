// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/skin_geometry.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>

#include "palmar/contact/response/response.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::contact {

namespace {

/// Everything but the neighbours, which `result` has.
void measure_skin(const geometry::TriangleMesh& skin, SkinGeometry& result) {
  result.position = skin.vertices;
  result.normal = geometry::area_weighted_normals(skin.vertices, skin.triangles);
  result.area = geometry::vertex_areas(skin);
  result.radius.clear();
  result.radius.reserve(result.area.size());
  for (const double a : result.area) result.radius.push_back(std::sqrt(a / std::numbers::pi));
  result.edge_length.resize(result.ring.size());
  for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
    for (int k = result.ring_begin[v]; k < result.ring_begin[v + 1]; ++k) {
      const int w = result.ring[k];
      result.edge_length[k] = (skin.vertices[v] - skin.vertices[w]).norm();
    }
  }
}

}  // namespace

SkinGeometry skin_geometry(const geometry::TriangleMesh& skin) {
  SkinGeometry result;
  std::vector<std::pair<int, int>> edges;
  edges.reserve(6 * skin.triangles.size());
  for (const Triangle& t : skin.triangles) {
    for (int k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      edges.emplace_back(t[(k + 1) % 3], t[k]);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  result.ring_begin.assign(skin.vertices.size() + 1, 0);
  result.ring.reserve(edges.size());
  for (const auto& [a, b] : edges) {
    ++result.ring_begin[a + 1];
    result.ring.push_back(b);
  }
  for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
    result.ring_begin[v + 1] += result.ring_begin[v];
  }
  measure_skin(skin, result);
  return result;
}

SkinGeometry skin_geometry_like(const geometry::TriangleMesh& skin, const SkinGeometry& other) {
  SkinGeometry result;
  result.ring_begin = other.ring_begin;
  result.ring = other.ring;
  measure_skin(skin, result);
  return result;
}

SensorCells sensor_cells(const SkinGeometry& skin, std::span<const int> centres,
                         std::span<const double> cell_area) {
  SensorCells cells;
  cells.begin.reserve(centres.size() + 1);
  cells.begin.push_back(0);
  std::vector<int> near;
  std::vector<int> mark(skin.position.size(), -1);
  for (std::size_t c = 0; c < centres.size(); ++c) {
    const int centre = centres[c];
    const double cell_radius = std::sqrt(cell_area[c] / std::numbers::pi);
    near.assign(1, centre);
    mark[centre] = centre;
    for (std::size_t k = 0; k < near.size(); ++k) {
      const int v = near[k];
      // No arc is shorter than its chord.
      const double farthest = cell_radius + skin.radius[v];
      if ((skin.position[v] - skin.position[centre]).squaredNorm() >= farthest * farthest) continue;
      const double shared =
          disc_overlap(arc_distance(skin, centre, v), cell_radius, skin.radius[v]);
      if (shared <= 0.0) continue;
      cells.vertex.push_back(v);
      cells.shared.push_back(shared);
      for (const int w : skin.neighbours(v)) {
        if (mark[w] == centre) continue;
        mark[w] = centre;
        near.push_back(w);
      }
    }
    cells.begin.push_back(static_cast<int>(cells.vertex.size()));
  }
  return cells;
}

double arc_distance(const SkinGeometry& skin, int i, int j) {
  const Vec3 chord = skin.position[j] - skin.position[i];
  const Vec3 turn = skin.normal[j] - skin.normal[i];
  // |turn| = 2 sin(phi / 2) for unit normals.
  const double turn2 = turn.squaredNorm();
  const double chord2 = chord.squaredNorm();
  if (turn2 < 1e-8) return std::sqrt(chord2);
  const double sine = std::min(1.0, 0.5 * std::sqrt(turn2));
  const double stretch = std::asin(sine) / sine;
  const double along = chord.dot(turn);
  return std::sqrt(chord2 + along * along / turn2 * (stretch * stretch - 1.0));
}

std::vector<GrownVertex> grow(const SkinGeometry& skin, std::span<const int> sources,
                              double distance) {
  std::vector<double> reached(skin.position.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::vector<int> touched;
  for (const int s : sources) {
    if (reached[s] == 0.0) continue;
    reached[s] = 0.0;
    touched.push_back(s);
    front.emplace(0.0, s);
  }
  while (!front.empty()) {
    const auto [d, v] = front.top();
    front.pop();
    if (d > reached[v]) continue;
    for (int k = skin.ring_begin[v]; k < skin.ring_begin[v + 1]; ++k) {
      const int w = skin.ring[k];
      const double candidate = d + skin.edge_length[k];
      if (candidate > distance || candidate >= reached[w]) continue;
      if (!std::isfinite(reached[w])) touched.push_back(w);
      reached[w] = candidate;
      front.emplace(candidate, w);
    }
  }
  std::sort(touched.begin(), touched.end());
  std::vector<GrownVertex> result;
  result.reserve(touched.size());
  for (const int v : touched) result.push_back({v, reached[v]});
  return result;
}

std::vector<std::vector<int>> connected_parts(const SkinGeometry& skin,
                                              const std::vector<int>& vertices) {
  std::vector<std::vector<int>> parts;
  std::vector<char> pending(skin.position.size(), 0);
  for (const int v : vertices) pending[v] = 1;
  for (const int seed : vertices) {
    if (!pending[seed]) continue;
    std::vector<int> part = {seed};
    pending[seed] = 0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      for (const int w : skin.neighbours(part[k])) {
        if (!pending[w]) continue;
        pending[w] = 0;
        part.push_back(w);
      }
    }
    std::sort(part.begin(), part.end());
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace palmar::contact
