// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/iso_lines.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

void check_size(const TriangleMesh& mesh, std::span<const double> field) {
  if (field.size() == mesh.vertices.size()) return;
  throw UsageError("level lines: the field has " + std::to_string(field.size()) +
                   " values; one for each of the mesh's " + std::to_string(mesh.vertices.size()) +
                   " vertices is required");
}

/// Vertices where a line couldn't go on.
std::vector<char> blocked_vertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<char> blocked(mesh.vertices.size(), 0);
  for (std::size_t h = 0; h < topology.twin.size(); ++h) {
    if (topology.edge_of[h] < 0) continue;
    const int twin = topology.twin[h];
    const auto start = [&](int half) { return mesh.triangles[half / 3][half % 3]; };
    const int half = static_cast<int>(h);
    const bool runs_on = twin >= 0 && start(twin) != start(half);
    if (runs_on) continue;
    blocked[start(half)] = 1;
    blocked[start(MeshTopology::next(half))] = 1;
  }
  return blocked;
}

std::vector<char> inside_vertices(const TriangleMesh& mesh, const MeshTopology& topology,
                                  std::span<const double> field, double level) {
  std::vector<char> inside = blocked_vertices(mesh, topology);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    inside[v] = static_cast<char>(inside[v] == 0 && field[v] >= level);
  }
  return inside;
}

/// Where the level lies between an inside and an outside vertex, as a share of the way.
double crossing(double inside, double outside, double level) {
  // A blocked vertex may be above the level itself: then the line keeps to the middle.
  if (!(outside < level)) return 0.5;
  return std::clamp((inside - level) / (inside - outside), 0.0, 1.0);
}

/// Share of a triangle that lies above, from its corners.
double share_above(const std::array<double, 3>& f, const std::array<char, 3>& in, double level) {
  const int count = in[0] + in[1] + in[2];
  if (count == 0) return 0.0;
  if (count == 3) return 1.0;
  // The corner that stands alone on its side.
  int alone = 0;
  while ((in[alone] != 0) != (count == 1)) ++alone;
  double share = 1.0;
  for (int k = 1; k <= 2; ++k) {
    const int other = (alone + k) % 3;
    share *= count == 1 ? crossing(f[alone], f[other], level)
                        : 1.0 - crossing(f[other], f[alone], level);
  }
  return count == 1 ? share : 1.0 - share;
}

std::vector<double> areas_of(const TriangleMesh& mesh, const std::vector<char>& inside,
                             std::span<const double> field, double level) {
  std::vector<double> areas;
  areas.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const double share =
        share_above({field[a], field[b], field[c]}, {inside[a], inside[b], inside[c]}, level);
    areas.push_back(share * triangle_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return areas;
}

}  // namespace

std::vector<IsoLoop> iso_loops(const TriangleMesh& mesh, std::span<const double> field,
                               double level) {
  check_size(mesh, field);
  const MeshTopology topology = build_topology(mesh);
  const std::vector<char> inside = inside_vertices(mesh, topology, field, level);
  // In every crossed triangle the line enters through the edge that leads out of the inside and
  // leaves through the one that leads back in.
  std::vector<int> next(topology.edge.size(), -1);
  std::vector<char> is_crossed(topology.edge.size(), 0);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    int from = -1, to = -1;
    for (int k = 0; k < 3; ++k) {
      const int edge = topology.edge_of[3 * t + k];
      if (edge < 0) break;
      const bool a = inside[mesh.triangles[t][k]] != 0;
      const bool b = inside[mesh.triangles[t][(k + 1) % 3]] != 0;
      if (a && !b) from = edge;
      if (b && !a) to = edge;
    }
    if (from >= 0 && to >= 0) next[from] = to;
  }
  std::vector<IsoLoop> loops;
  for (std::size_t first = 0; first < next.size(); ++first) {
    if (next[first] < 0 || is_crossed[first] != 0) continue;
    IsoLoop loop;
    for (auto e = first; is_crossed[e] == 0; e = static_cast<std::size_t>(next[e])) {
      is_crossed[e] = 1;
      auto [a, b] = topology.edge[e];
      if (inside[a] == 0) std::swap(a, b);
      if (loop.inside_vertex < 0) loop.inside_vertex = a;
      const double way = crossing(field[a], field[b], level);
      loop.points.push_back(mesh.vertices[a] + way * (mesh.vertices[b] - mesh.vertices[a]));
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<double> areas_above(const TriangleMesh& mesh, std::span<const double> field,
                                double level) {
  check_size(mesh, field);
  return areas_of(mesh, inside_vertices(mesh, build_topology(mesh), field, level), field, level);
}

IsoParts iso_parts(const TriangleMesh& mesh, std::span<const double> field, double level) {
  check_size(mesh, field);
  const MeshTopology topology = build_topology(mesh);
  const std::vector<char> inside = inside_vertices(mesh, topology, field, level);
  std::vector<int> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&root](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& [a, b] : topology.edge) {
    if (inside[a] == inside[b]) {
      const int p = find(a), q = find(b);
      root[std::max(p, q)] = std::min(p, q);  // the smallest vertex stands for its part
    }
  }
  IsoParts parts;
  parts.of_vertex.resize(mesh.vertices.size());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int r = find(v);
    if (r == v) {
      parts.of_vertex[v] = static_cast<int>(parts.is_inside.size());
      parts.is_inside.push_back(inside[v]);
    } else {
      parts.of_vertex[v] = parts.of_vertex[r];
    }
  }
  parts.area.assign(parts.is_inside.size(), 0.0);
  const std::vector<double> above = areas_of(mesh, inside, field, level);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double below =
        triangle_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]) - above[t];
    // Corners on one side of one triangle are joined by an edge: they are in the same part.
    int in = -1, out = -1;
    for (const int v : mesh.triangles[t]) (inside[v] != 0 ? in : out) = v;
    if (in >= 0) parts.area[parts.of_vertex[in]] += above[t];
    if (out >= 0) parts.area[parts.of_vertex[out]] += below;
  }
  return parts;
}

}  // namespace palmar::geometry
