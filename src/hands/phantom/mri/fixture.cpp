// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "hands/phantom/mri/subject_tissues.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::phantom {
namespace {

constexpr double kSpacing = 1.5;               // mm, of the relief
constexpr double kHalfWidth = 36.0;            // mm
constexpr double kBegin = -82.0, kEnd = 12.0;  // mm along y from the wrist joint
constexpr double kThickness = 12.0;            // below the deepest point, mm

}  // namespace

geometry::TriangleMesh fixture_mesh(const geometry::TriangleMesh& skin, const Vec3& wrist) {
  const geometry::RayQuery rays(skin);
  const int columns = static_cast<int>(2.0 * kHalfWidth / kSpacing) + 1;
  const int rows = static_cast<int>((kEnd - kBegin) / kSpacing) + 1;
  const auto place = [&](int column, int row) -> Vec3 {
    return wrist + Vec3(-kHalfWidth + column * kSpacing, kBegin + row * kSpacing, 0.0);
  };
  const auto node = [&](int column, int row) { return row * columns + column; };
  // Relief: the palmar skin; beside it walls as high as the middle of the forearm.
  std::vector<double> palmar(columns * rows), relief(columns * rows);
  double deepest = wrist.z();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Vec3 from = place(column, row);
      from.z() = wrist.z() - 150.0;
      const std::vector<geometry::RayHit> hits = rays.all_hits(from, Vec3::UnitZ());
      double z = wrist.z() - 2.0;
      if (!hits.empty()) z = std::max(z, from.z() + hits.back().distance);
      palmar[node(column, row)] = z;
      deepest = std::max(deepest, z);
    }
  }
  relief = palmar;
  for (int pass = 0; pass < 6; ++pass) {
    const std::vector<double> before = relief;
    for (int row = 1; row + 1 < rows; ++row) {
      for (int column = 1; column + 1 < columns; ++column) {
        relief[node(column, row)] =
            0.25 * (before[node(column - 1, row)] + before[node(column + 1, row)] +
                    before[node(column, row - 1)] + before[node(column, row + 1)]);
      }
    }
  }
  geometry::TriangleMesh mesh;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Vec3 v = place(column, row);
      // Pressed in, let go a little, and uneven.
      const double height_above =
          1.6 + 1.9 * std::sin(0.19 * v.y() + 0.6) * std::cos(0.13 * v.x() + 0.4);
      v.z() = std::max(relief[node(column, row)], palmar[node(column, row)]) +
              std::max(height_above, -0.1);
      mesh.vertices.push_back(v);
    }
  }
  const int below = mesh.vertex_count();
  for (int n = 0; n < below; ++n) {
    Vec3 v = mesh.vertices[n];
    v.z() = deepest + kThickness;
    mesh.vertices.push_back(v);
  }
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = node(column, row), b = node(column + 1, row), c = node(column + 1, row + 1),
                d = node(column, row + 1);
      quad(a, d, c, b);
      quad(below + a, below + b, below + c, below + d);
    }
  }
  const auto wall = [&](int a, int b) { quad(a, b, below + b, below + a); };
  for (int column = 0; column + 1 < columns; ++column) {
    wall(node(column, 0), node(column + 1, 0));
    wall(node(column + 1, rows - 1), node(column, rows - 1));
  }
  for (int row = 0; row + 1 < rows; ++row) {
    wall(node(columns - 1, row), node(columns - 1, row + 1));
    wall(node(0, row + 1), node(0, row));
  }
  if (geometry::signed_volume(mesh) < 0.0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

}  // namespace palmar::phantom
