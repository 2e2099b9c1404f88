// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/weld.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <unordered_map>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

// Cells of a grid; vertices within the tolerance lie in the same or in neighbouring cells.
class CellGrid {
 public:
  CellGrid(const TriangleMesh& mesh, double tolerance) : cell_(tolerance) {
    double size = 0.0;
    for (const Vec3& v : mesh.vertices) size = std::max(size, v.cwiseAbs().maxCoeff());
    // Cell numbers must stay exact integers; far from the origin the grid gets coarser.
    cell_ = std::max({tolerance, size * 1e-15, std::numeric_limits<double>::min()});
  }
  std::array<int64_t, 3> cell_of(const Vec3& p) const {
    return {static_cast<int64_t>(std::floor(p.x() / cell_)),
            static_cast<int64_t>(std::floor(p.y() / cell_)),
            static_cast<int64_t>(std::floor(p.z() / cell_))};
  }

 private:
  double cell_;
};

struct CellHash {
  size_t operator()(const std::array<int64_t, 3>& cell) const {
    uint64_t h = 1469598103934665603ULL;
    for (const int64_t c : cell) {
      h ^= static_cast<uint64_t>(c);
      h *= 0x9E3779B97F4A7C15ULL;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

// Kept vertex that each vertex joins (itself if kept).
std::vector<int> find_representatives(const TriangleMesh& mesh, const std::vector<int>& group,
                                      double tolerance) {
  const CellGrid grid(mesh, tolerance);
  const double squared = tolerance * tolerance;
  // Only looked up, never walked through, so its order doesn't matter. Per cell a chain of kept
  // vertices, newest first.
  std::unordered_map<std::array<int64_t, 3>, int, CellHash> newest;
  newest.reserve(mesh.vertices.size());
  std::vector<int> previous(mesh.vertices.size(), -1);
  std::vector<int> representative(mesh.vertices.size());
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3& p = mesh.vertices[i];
    const auto cell = grid.cell_of(p);
    int best = i;
    const int64_t reach = tolerance > 0.0 ? 1 : 0;
    for (int64_t dx = -reach; dx <= reach; ++dx) {
      for (int64_t dy = -reach; dy <= reach; ++dy) {
        for (int64_t dz = -reach; dz <= reach; ++dz) {
          const auto entry = newest.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (entry == newest.end()) continue;
          for (int j = entry->second; j >= 0; j = previous[j]) {
            if (j < best && group[j] == group[i] &&
                (mesh.vertices[j] - p).squaredNorm() <= squared) {
              best = j;
            }
          }
        }
      }
    }
    representative[i] = best;
    if (best != i) continue;
    const auto [entry, is_new] = newest.try_emplace(cell, i);
    if (!is_new) {
      previous[i] = entry->second;
      entry->second = i;
    }
  }
  return representative;
}

/// Group of each vertex: that of the first triangle that uses it.
std::vector<int> vertex_groups(const TriangleMesh& mesh, const std::vector<int>& of_triangle) {
  std::vector<int> group(mesh.vertices.size(), -1);
  if (of_triangle.empty()) return group;
  if (of_triangle.size() != mesh.triangles.size()) {
    throw InputError("weld: groups of " + std::to_string(of_triangle.size()) +
                     " triangles; there are " + std::to_string(mesh.triangles.size()));
  }
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (group[v] < 0) group[v] = of_triangle[t];
    }
  }
  return group;
}

void check_mesh(const TriangleMesh& mesh) {
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].allFinite()) continue;
    std::ostringstream message;
    message << "mesh: vertex " << i << " is (" << mesh.vertices[i].transpose()
            << ") mm; finite coordinates are required";
    throw InputError(message.str());
  }
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && v < mesh.vertex_count()) continue;
      std::ostringstream message;
      message << "mesh: triangle " << t << " names vertex " << v << "; there are "
              << mesh.vertex_count() << " vertices";
      throw InputError(message.str());
    }
  }
}

}  // namespace

void WeldOptions::check() const {
  if (std::isfinite(tolerance) && tolerance >= 0.0) return;
  std::ostringstream message;
  message << "weld: tolerance is " << tolerance << " mm; a finite length of at least 0 is required";
  throw UsageError(message.str());
}

WeldResult weld(const TriangleMesh& mesh, const WeldOptions& options) {
  options.check();
  check_mesh(mesh);
  const std::vector<int> representative =
      find_representatives(mesh, vertex_groups(mesh, options.groups), options.tolerance);
  WeldResult result;

  std::vector<Triangle> kept;
  kept.reserve(mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Triangle r{representative[t[0]], representative[t[1]], representative[t[2]]};
    if (r[0] == r[1] || r[1] == r[2] || r[2] == r[0]) {
      ++result.dropped_degenerate;
    } else {
      kept.push_back(r);
      result.old_triangle_of_new.push_back(static_cast<int>(i));
    }
  }
  if (options.drops_duplicates) {
    std::vector<std::pair<Triangle, int>> keys;
    keys.reserve(kept.size());
    for (size_t t = 0; t < kept.size(); ++t) {
      Triangle key = kept[t];
      std::sort(key.begin(), key.end());
      keys.emplace_back(key, static_cast<int>(t));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<bool> is_duplicate(kept.size(), false);
    for (size_t k = 1; k < keys.size(); ++k) {
      if (keys[k].first != keys[k - 1].first) continue;
      is_duplicate[keys[k].second] = true;
      ++result.dropped_duplicate;
    }
    size_t end = 0;
    for (size_t t = 0; t < kept.size(); ++t) {
      if (is_duplicate[t]) continue;
      result.old_triangle_of_new[end] = result.old_triangle_of_new[t];
      kept[end++] = kept[t];
    }
    kept.resize(end);
    result.old_triangle_of_new.resize(end);
  }

  std::vector<bool> is_used(mesh.vertices.size(), !options.drops_unused_vertices);
  for (const Triangle& t : kept) {
    for (const int v : t) is_used[v] = true;
  }
  result.new_of_old.assign(mesh.vertices.size(), -1);
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    if (representative[i] != i) {
      ++result.merged_vertices;
      result.new_of_old[i] = result.new_of_old[representative[i]];
    } else if (is_used[i]) {
      result.new_of_old[i] = result.mesh.vertex_count();
      result.old_of_new.push_back(i);
      result.mesh.vertices.push_back(mesh.vertices[i]);
    } else {
      ++result.dropped_unused;
    }
  }
  for (Triangle& t : kept) {
    for (int& v : t) v = result.new_of_old[v];
  }
  result.mesh.triangles = std::move(kept);
  return result;
}

}  // namespace palmar::geometry
