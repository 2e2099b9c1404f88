// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/skin_sampling.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace palmar::hand {
namespace {

/// A third of the triangles round each vertex, mm^2.
std::vector<double> thirds_of_area(const geometry::TriangleMesh& mesh) {
  std::vector<double> area(mesh.vertices.size(), 0.0);
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const double third = (b - a).cross(c - a).norm() / 6.0;
    for (const int v : t) area[v] += third;
  }
  return area;
}

}  // namespace

SkinSample sample_skin(const Hand& hand, double spacing) {
  const std::vector<double> area = thirds_of_area(hand.skin);
  SkinSample sample;
  if (spacing <= 0.0) {
    for (int v = 0; v < hand.skin.vertex_count(); ++v) sample.vertex.push_back(v);
    sample.entry = sample.vertex;
    sample.area = area;
    return sample;
  }
  std::map<std::array<int, 3>, std::vector<int>> cells;  // entries of the sample by grid cell
  for (int v = 0; v < hand.skin.vertex_count(); ++v) {
    const Vec3& p = hand.skin.vertices[v];
    std::array<int, 3> cell{};
    for (int c = 0; c < 3; ++c) {
      cell[c] = static_cast<int>(std::floor(p[c] / spacing));
    }
    int nearest = -1;
    double distance = spacing;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = cells.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (found == cells.end()) continue;
          for (const int entry : found->second) {
            const int other = sample.vertex[entry];
            if (hand.region[other] != hand.region[v] || hand.segment[other] != hand.segment[v]) {
              continue;
            }
            const double d = (hand.skin.vertices[other] - p).norm();
            if (d < distance) {
              distance = d;
              nearest = entry;
            }
          }
        }
      }
    }
    sample.entry.push_back(nearest >= 0 ? nearest : static_cast<int>(sample.vertex.size()));
    if (nearest >= 0) {
      sample.area[nearest] += area[v];
    } else {
      cells[cell].push_back(static_cast<int>(sample.vertex.size()));
      sample.vertex.push_back(v);
      sample.area.push_back(area[v]);
    }
  }
  return sample;
}

}  // namespace palmar::hand
