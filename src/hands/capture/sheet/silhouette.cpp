// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/line_fit.h"

namespace palmar::capture {

imaging::VoxelMask silhouette(const geometry::TriangleMesh& body, const Vec3& eye,
                              const SheetGrid& grid) {
  std::vector<Vec2> place(body.vertices.size());
  std::vector<char> is_below(body.vertices.size(), 0);
  for (std::size_t v = 0; v < place.size(); ++v) {
    const Vec3& p = body.vertices[v];
    if (p.z() > 0.95 * eye.z()) continue;
    is_below[v] = 1;
    const Vec2 foot = eye.head<2>();
    place[v] = grid.place(foot + (p.head<2>() - foot) * (eye.z() / (eye.z() - p.z())));
  }
  imaging::VoxelMask mask(grid.count(), 0);
  for (const Triangle& triangle : body.triangles) {
    std::array<Vec2, 3> c;
    bool is_seen = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = triangle[k];
      is_seen = is_seen && is_below[v] != 0;
      c[k] = place[v];
    }
    if (!is_seen) continue;
    if (cross2(c[1] - c[0], c[2] - c[0]) < 0.0) std::swap(c[1], c[2]);
    const Vec2 low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    const int x0 = std::max(0, static_cast<int>(std::ceil(low.x()))),
              x1 = std::min(grid.width - 1, static_cast<int>(std::floor(high.x()))),
              y0 = std::max(0, static_cast<int>(std::ceil(low.y()))),
              y1 = std::min(grid.height - 1, static_cast<int>(std::floor(high.y())));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Vec2 p(x, y);
        if (cross2(c[1] - c[0], p - c[0]) >= 0.0 && cross2(c[2] - c[1], p - c[1]) >= 0.0 &&
            cross2(c[0] - c[2], p - c[2]) >= 0.0) {
          mask[grid.at(x, y)] = 1;
        }
      }
    }
  }
  return mask;
}

}  // namespace palmar::capture
