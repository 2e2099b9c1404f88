// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/cluster_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::geometry {

TriangleMesh cluster_vertices(const TriangleMesh& mesh, double spacing) {
  if (!(spacing > 0.0)) {
    throw UsageError("spacing is " + std::to_string(spacing) + " mm; more than 0 is required");
  }
  using Cell = std::array<std::int64_t, 3>;
  std::map<Cell, int> cell_index;
  std::vector<int> cell_of(mesh.vertices.size());
  TriangleMesh coarse;
  std::vector<int> count;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Cell cell;
    for (int c = 0; c < 3; ++c) {
      cell[c] = static_cast<std::int64_t>(std::floor(mesh.vertices[v][c] / spacing));
    }
    const auto [place, is_new] = cell_index.try_emplace(cell, coarse.vertex_count());
    if (is_new) {
      coarse.vertices.push_back(Vec3::Zero());
      count.push_back(0);
    }
    cell_of[v] = place->second;
    coarse.vertices[place->second] += mesh.vertices[v];
    ++count[place->second];
  }
  for (std::size_t k = 0; k < count.size(); ++k) coarse.vertices[k] /= count[k];
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.triangles) {
    Triangle s{cell_of[t[0]], cell_of[t[1]], cell_of[t[2]]};
    if (s[0] == s[1] || s[1] == s[2] || s[2] == s[0]) continue;
    std::rotate(s.begin(), std::min_element(s.begin(), s.end()), s.end());
    kept.push_back(s);
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  coarse.triangles = std::move(kept);
  return coarse;
}

}  // namespace palmar::geometry
