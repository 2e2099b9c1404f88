// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::product {

using Sdf = std::function<double(const Vec3&)>;

/// Welded closed mesh of {sdf < 0} within a box, by marching tetrahedra on a lattice of `spacing`:
/// unions of solids with a known answer for tests.
inline geometry::TriangleMesh mesh_of(const Sdf& sdf, const Box3& box, double spacing) {
  std::array<int, 3> n{};
  for (std::size_t a = 0; a < 3; ++a) {
    n[a] = static_cast<int>(std::ceil((box.sizes()[a]) / spacing)) + 3;
  }
  const Vec3 first = box.min() - Vec3::Constant(1.013 * spacing);
  const auto index = [&](int i, int j, int k) {
    return static_cast<std::int64_t>(i) + n[0] * (j + static_cast<std::int64_t>(n[1]) * k);
  };
  std::vector<double> value(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
  std::vector<Vec3> point(value.size());
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const Vec3 p = first + spacing * Vec3(i, j, k);
        point[index(i, j, k)] = p;
        value[index(i, j, k)] = sdf(p);
      }
    }
  }
  geometry::TriangleMesh mesh;
  std::unordered_map<std::int64_t, int> on_edge;
  const auto vertex = [&](std::int64_t a, std::int64_t b) {
    if (a > b) std::swap(a, b);
    const auto [entry, is_new] =
        on_edge.try_emplace(a * static_cast<std::int64_t>(value.size()) + b, mesh.vertex_count());
    if (is_new) {
      const double t = std::clamp(value[a] / (value[a] - value[b]), 0.02, 0.98);
      mesh.vertices.push_back(point[a] + t * (point[b] - point[a]));
    }
    return entry->second;
  };
  // Six tetrahedra about the diagonal of each cube.
  constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
      {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
  const auto add = [&](int a, int b, int c, const Vec3& outside) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    if ((q - p).cross(r - p).dot(outside - p) < 0.0) std::swap(b, c);
    mesh.triangles.push_back({a, b, c});
  };
  for (int k = 0; k + 1 < n[2]; ++k) {
    for (int j = 0; j + 1 < n[1]; ++j) {
      for (int i = 0; i + 1 < n[0]; ++i) {
        for (const auto& tetrahedron : kTetrahedra) {
          std::vector<std::int64_t> in, out;
          for (const int c : tetrahedron) {
            const std::int64_t at = index(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1));
            (value[at] < 0.0 ? in : out).push_back(at);
          }
          if (in.empty() || out.empty()) continue;
          Vec3 outside = Vec3::Zero();
          for (const std::int64_t at : out) outside += point[at] / static_cast<double>(out.size());
          if (in.size() == 1) {
            add(vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[0], out[2]), outside);
          } else if (in.size() == 3) {
            add(vertex(in[0], out[0]), vertex(in[1], out[0]), vertex(in[2], out[0]), outside);
          } else {
            const int a = vertex(in[0], out[0]), b = vertex(in[0], out[1]),
                      c = vertex(in[1], out[1]), d = vertex(in[1], out[0]);
            add(a, b, c, outside);
            add(a, c, d, outside);
          }
        }
      }
    }
  }
  return mesh;
}

/// Distance to a bar of a given radius along a polyline; round ends.
inline Sdf sdf_tube(std::vector<Vec3> line, double radius) {
  return [line = std::move(line), radius](const Vec3& p) {
    double least = 1e9;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Vec3 a = line[i], ab = line[i + 1] - a;
      const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p - a - t * ab).norm());
    }
    return least - radius;
  };
}

/// Cone about z with flat ends: radius `low` at z = 0 and `high` at z = length (not a distance
/// beside the surface, but right in sign).
inline Sdf sdf_cone(double length, double low, double high) {
  return [=](const Vec3& p) {
    const double t = std::clamp(p.z() / length, 0.0, 1.0);
    const double side = std::hypot(p.x(), p.y()) - (low + t * (high - low));
    return std::max({side, -p.z(), p.z() - length});
  };
}

inline Sdf sdf_box(const Vec3& middle, const Vec3& size) {
  return [=](const Vec3& p) {
    const Vec3 d = (p - middle).cwiseAbs() - 0.5 * size;
    return d.maxCoeff();
  };
}

inline Sdf sdf_union(const Sdf& a, const Sdf& b) {
  return [=](const Vec3& p) { return std::min(a(p), b(p)); };
}
inline Sdf sdf_without(const Sdf& a, const Sdf& b) {
  return [=](const Vec3& p) { return std::max(a(p), -b(p)); };
}

}  // namespace palmar::product
