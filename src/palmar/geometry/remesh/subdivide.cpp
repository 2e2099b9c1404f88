// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/subdivide.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

void require_range(const char* name, int value, int lowest, int highest) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream message;
  message << "subdivision: " << name << " is " << value << "; allowed are " << lowest << " to "
          << highest;
  throw UsageError(message.str());
}

// Neighbourhood of each vertex summed over its edges: all of them for an inner vertex, the border
// edges alone for a vertex on a border.
struct Ring {
  Vec3 sum = Vec3::Zero();
  int count = 0;
};

struct Rings {
  std::vector<Ring> inner, border;
};

Rings sum_rings(const MeshTopology& topology, const std::vector<Vec3>& points) {
  Rings rings{std::vector<Ring>(points.size()), std::vector<Ring>(points.size())};
  for (size_t e = 0; e < topology.edge.size(); ++e) {
    const int a = topology.edge[e][0];
    const int b = topology.edge[e][1];
    const auto add = [&](std::vector<Ring>& ring) {
      ring[a].sum += points[b];
      ring[b].sum += points[a];
      ++ring[a].count;
      ++ring[b].count;
    };
    add(rings.inner);
    if (topology.edge_use[e] != 2) add(rings.border);
  }
  return rings;
}

double inner_weight(int n) { return n == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * n); }

enum class Mask { kRefine, kLimit };

// Loop's vertex rule (kRefine) or the limit position (kLimit) of every vertex. A vertex where other
// than two border edges meet is a corner and stays.
std::vector<Vec3> apply_vertex_mask(const MeshTopology& topology, const std::vector<Vec3>& points,
                                    Mask mask) {
  const Rings rings = sum_rings(topology, points);
  std::vector<Vec3> result = points;
  for (size_t v = 0; v < points.size(); ++v) {
    const Ring& border = rings.border[v];
    const Ring& inner = rings.inner[v];
    if (border.count == 2) {
      const double w = mask == Mask::kRefine ? 1.0 / 8.0 : 1.0 / 6.0;
      result[v] = (1.0 - 2.0 * w) * points[v] + w * border.sum;
    } else if (border.count == 0 && inner.count >= 3) {
      const double beta = inner_weight(inner.count);
      const double w = mask == Mask::kRefine ? beta : 1.0 / (inner.count + 3.0 / (8.0 * beta));
      result[v] = (1.0 - inner.count * w) * points[v] + w * inner.sum;
    }
  }
  return result;
}

TriangleMesh refine(const TriangleMesh& mesh, const MeshTopology& topology) {
  TriangleMesh result;
  result.vertices = apply_vertex_mask(topology, mesh.vertices, Mask::kRefine);
  const size_t n = mesh.vertices.size();
  result.vertices.resize(n + topology.edge.size(), Vec3::Zero());
  const auto at = [&](int v) -> const Vec3& { return mesh.vertices[v]; };
  for (size_t e = 0; e < topology.edge.size(); ++e) {
    const Vec3 ends = at(topology.edge[e][0]) + at(topology.edge[e][1]);
    result.vertices[n + e] = (topology.edge_use[e] == 2 ? 3.0 / 8.0 : 0.5) * ends;
  }
  for (size_t h = 0; h < topology.edge_of.size(); ++h) {
    if (topology.edge_of[h] < 0) continue;
    const auto e = static_cast<std::size_t>(topology.edge_of[h]);
    if (topology.edge_use[e] != 2) continue;
    result.vertices[n + e] += at(mesh.triangles[h / 3][(h + 2) % 3]) / 8.0;
  }
  result.triangles.reserve(4 * mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.edge_of[3 * t] < 0) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const auto middle = [&](size_t k) { return static_cast<int>(n) + topology.edge_of[3 * t + k]; };
    const int ab = middle(0), bc = middle(1), ca = middle(2);
    for (const Triangle& child :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      result.triangles.push_back(child);
    }
  }
  return result;
}

// How far the fit moves each vertex of the control mesh.
std::vector<Vec3> fit_displacement(const TriangleMesh& mesh, const MeshTopology& topology,
                                   const SubdivisionOptions& options) {
  std::vector<Vec3> control = mesh.vertices;
  for (int round = 0; round < options.fit_rounds; ++round) {
    const std::vector<Vec3> limit = apply_vertex_mask(topology, control, Mask::kLimit);
    for (size_t v = 0; v < limit.size(); ++v) control[v] += mesh.vertices[v] - limit[v];
  }
  for (size_t v = 0; v < control.size(); ++v) control[v] -= mesh.vertices[v];
  return control;
}

TriangleMesh refine_shifted(const TriangleMesh& mesh, const std::vector<Vec3>& shift, double share,
                            const SubdivisionOptions& options) {
  TriangleMesh result = mesh;
  for (size_t v = 0; v < shift.size(); ++v) result.vertices[v] += share * shift[v];
  MeshTopology topology = build_topology(result);
  for (int level = 0; level < options.levels; ++level) {
    result = refine(result, topology);
    topology = build_topology(result);
  }
  if (options.projects_to_limit) {
    result.vertices = apply_vertex_mask(topology, result.vertices, Mask::kLimit);
  }
  return result;
}

void require_closed(const TriangleMesh& mesh, const MeshTopology& topology) {
  const auto borders = boundary_edges(topology);
  if (!borders.empty() || mesh.triangles.empty()) {
    std::ostringstream message;
    message << "subdivision: the mesh has " << mesh.triangle_count() << " triangles and "
            << borders.size() << " border edges; keeping the volume requires a closed mesh";
    throw InputError(message.str());
  }
}

}  // namespace

void SubdivisionOptions::check() const {
  require_range("levels", levels, 0, 6);
  require_range("fit_rounds", fit_rounds, 0, 1000);
}

TriangleMesh subdivide(const TriangleMesh& mesh, const SubdivisionOptions& options) {
  options.check();
  const MeshTopology topology = build_topology(mesh);
  const std::vector<Vec3> fit = fit_displacement(mesh, topology, options);
  if (options.scheme == SubdivisionScheme::kLoop) return refine_shifted(mesh, fit, 0.0, options);
  if (options.scheme == SubdivisionScheme::kFittedLoop) {
    return refine_shifted(mesh, fit, 1.0, options);
  }
  require_closed(mesh, topology);

  // The volume is a cubic of the share, nearly straight: false position (Illinois variant).
  const double wanted = signed_volume(mesh);
  const double tolerance = 1e-6 * std::abs(wanted);
  struct End {
    double share, excess;
  };
  TriangleMesh result = refine_shifted(mesh, fit, 0.0, options);
  End low{0.0, signed_volume(result) - wanted};
  if (std::abs(low.excess) <= tolerance) return result;
  TriangleMesh full = refine_shifted(mesh, fit, 1.0, options);
  End high{1.0, signed_volume(full) - wanted};
  if (low.excess * high.excess >= 0.0) {
    return std::abs(high.excess) < std::abs(low.excess) ? full : result;
  }
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double share =
        (low.share * high.excess - high.share * low.excess) / (high.excess - low.excess);
    result = refine_shifted(mesh, fit, share, options);
    const End middle{share, signed_volume(result) - wanted};
    if (std::abs(middle.excess) <= tolerance) break;
    if (middle.excess * high.excess < 0.0) {
      low = high;
    } else {
      low.excess *= 0.5;
    }
    high = middle;
  }
  return result;
}

}  // namespace palmar::geometry
