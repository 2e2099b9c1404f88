// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_labels.h"

#include <algorithm>
#include <cstddef>
#include <map>

#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::product {

std::vector<int> labels_of(const geometry::TriangleMesh& mesh, const SolidGrid& grid,
                           const RoughParts& rough) {
  std::vector<int> label(mesh.triangles.size(), 0);
  constexpr int kBlock = 512;
  const int count = mesh.triangle_count();
  parallel_for((count + kBlock - 1) / kBlock, [&](int block) {
    for (int t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t) {
      const Triangle& corner = mesh.triangles[t];
      const Vec3 middle =
          (mesh.vertices[corner[0]] + mesh.vertices[corner[1]] + mesh.vertices[corner[2]]) / 3.0;
      label[t] = std::max(0, nearest_part(rough.balls, grid.product_from_grid.to_grid(middle)));
    }
  });
  return label;
}

void absorb_islands(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology,
                    std::vector<int>& label) {
  constexpr double kIsland = 0.2;  // share of the part's largest piece
  const int count = mesh.triangle_count();
  for (int round = 0; round < 4; ++round) {
    std::vector<int> piece(count, -1);
    std::vector<double> area;
    std::vector<int> part, stack;
    for (int start = 0; start < count; ++start) {
      if (piece[start] >= 0) continue;
      const int id = static_cast<int>(area.size());
      area.push_back(0.0);
      part.push_back(label[start]);
      stack.assign(1, start);
      piece[start] = id;
      while (!stack.empty()) {
        const int t = stack.back();
        stack.pop_back();
        const Triangle& c = mesh.triangles[t];
        area[id] +=
            geometry::triangle_area(mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]);
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
          const int other = topology.twin[h] < 0 ? -1 : topology.twin[h] / 3;
          if (other < 0 || piece[other] >= 0 || label[other] != label[start]) continue;
          piece[other] = id;
          stack.push_back(other);
        }
      }
    }
    std::map<int, double> largest;
    for (std::size_t p = 0; p < area.size(); ++p) {
      largest[part[p]] = std::max(largest[part[p]], area[p]);
    }
    std::vector<std::map<int, double>> border(area.size());
    for (int t = 0; t < count; ++t) {
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int other = topology.twin[h] < 0 ? -1 : topology.twin[h] / 3;
        if (other < 0 || piece[other] == piece[t]) continue;
        const Triangle& c = mesh.triangles[t];
        border[piece[t]][label[other]] +=
            (mesh.vertices[c[(h + 1) % 3]] - mesh.vertices[c[h % 3]]).norm();
      }
    }
    bool has_changed = false;
    for (int t = 0; t < count; ++t) {
      const int p = piece[t];
      if (area[p] >= kIsland * largest[part[p]] || border[p].empty()) continue;
      int best = -1;
      double longest = 0.0;
      for (const auto& [other, length] : border[p]) {
        if (length > longest) {
          longest = length;
          best = other;
        }
      }
      if (best < 0 || best == label[t]) continue;
      label[t] = best;
      has_changed = true;
    }
    if (!has_changed) break;
  }
}

void give_to_joined(const geometry::TriangleMesh& mesh, const RoughPart& rough,
                    const std::vector<Vec3>& line, int id, std::vector<int>& label) {
  for (std::size_t t = 0; t < label.size(); ++t) {
    if (label[t] != id) continue;
    const Triangle& c = mesh.triangles[t];
    const Vec3 x = (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3.0;
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      if ((line[i] - x).squaredNorm() < (line[nearest] - x).squaredNorm()) nearest = i;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t end = k == 0 ? 0 : line.size() - 1;
      if (nearest != end || rough.end_part[k] < 0) continue;
      const Vec3 out = k == 0 ? Vec3(line[0] - line[1]) : Vec3(line[end] - line[end - 1]);
      if (out.dot(x - line[end]) > 0.0) label[t] = rough.end_part[k];
    }
  }
}

geometry::TriangleMesh piece_of(const geometry::TriangleMesh& mesh, const std::vector<int>& label,
                                int part) {
  geometry::TriangleMesh piece;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (label[t] != part) continue;
    Triangle triangle = mesh.triangles[t];
    for (int& i : triangle) {
      if (index[i] < 0) {
        index[i] = piece.vertex_count();
        piece.vertices.push_back(mesh.vertices[i]);
      }
      i = index[i];
    }
    piece.triangles.push_back(triangle);
  }
  return piece;
}

}  // namespace palmar::product
