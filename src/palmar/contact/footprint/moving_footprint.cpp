// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/footprint/moving_footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"

namespace palmar::contact {
namespace {

// mm; skin that is on the product lies nearer. At the edge of a contact facets lead off it.
constexpr double kOnSkin = 1.0;
// mm; as far beside its facet a vertex is looked for: facets cut through a curved surface.
constexpr double kMargin = 0.5;
// Of a facet's height, beyond its sides, so that no vertex falls between two.
constexpr double kOver = 0.02;
constexpr double kOpposed = 0.3;  // cosine; skin and product normals must not agree by more
constexpr double kCell = 3.0;     // mm
constexpr double kMostGridCells = 1e6;

// Mean area of a triangle over its longest edge squared: an equilateral one has 0.43, one of halves
// of a square 0.25.
constexpr double kSplitTriangle = 0.3;
constexpr double kCoarser = 1.3;
constexpr double kLongestEdge = 1000.0;  // mm
constexpr double kSkinEdge = 2.5;        // mm; the template hand's skin has edges of 2 to 4

}  // namespace

MovingFootprint::MovingFootprint(geometry::TriangleMesh surface) : surface_(std::move(surface)) {
  normal_ = geometry::area_weighted_normals(surface_.vertices, surface_.triangles);
  const std::size_t n = surface_.vertices.size();
  off_.assign(n, std::numeric_limits<double>::infinity());
  pressure_.assign(n, 0.0);
  Box3 box;
  for (const Vec3& v : surface_.vertices) box.extend(v);
  if (box.isEmpty()) return;
  low_ = box.min();
  const Vec3 sides = box.sizes();
  cell_ = kCell;
  while (((sides / cell_).array() + 1.0).prod() > kMostGridCells) cell_ *= 2.0;
  for (int k = 0; k < 3; ++k) cells_[k] = static_cast<int>(sides[k] / cell_) + 1;
  const auto index = [&](const Vec3& v) {
    const auto [x, y, z] = cell_of(v);
    return (z * cells_[1] + y) * cells_[0] + x;
  };
  begin_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
  for (const Vec3& v : surface_.vertices) ++begin_[index(v) + 1];
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  vertex_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    vertex_[next[index(surface_.vertices[i])]++] = static_cast<int>(i);
  }
}

std::array<int, 3> MovingFootprint::cell_of(const Vec3& point) const {
  std::array<int, 3> cell{};
  for (int k = 0; k < 3; ++k) {
    const double at = std::floor((point[k] - low_[k]) / cell_);
    cell[k] = static_cast<int>(std::clamp(at, 0.0, cells_[k] - 1.0));
  }
  return cell;
}

void MovingFootprint::press(const std::array<Vec3, 3>& facet,
                            const std::array<double, 3>& pressure) {
  const Vec3& a = facet[0];
  const Vec3 ab = facet[1] - a, ac = facet[2] - a;
  const Vec3 across = ab.cross(ac);
  const double twice_area = across.norm();
  if (!(twice_area > 0.0)) return;
  const Vec3 normal = across / twice_area;
  // Shares of b and c at a point are its products with these.
  const Vec3 to_b = ac.cross(normal) / twice_area, to_c = normal.cross(ab) / twice_area;
  Box3 box(a);
  box.extend(facet[1]);
  box.extend(facet[2]);
  box.min().array() -= kMargin;
  box.max().array() += kMargin;
  const std::array<int, 3> first = cell_of(box.min()), last = cell_of(box.max());
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      const int row = (z * cells_[1] + y) * cells_[0];
      for (int k = begin_[row + first[0]]; k < begin_[row + last[0] + 1]; ++k) {
        const int v = vertex_[k];
        const Vec3 at = surface_.vertices[v] - a;
        const double b = at.dot(to_b), c = at.dot(to_c);
        if (b < -kOver || c < -kOver || b + c > 1.0 + kOver) continue;
        const double off = std::abs(at.dot(normal));
        if (off > kOnSkin || off >= off_[v] || normal.dot(normal_[v]) > kOpposed) continue;
        if (!std::isfinite(off_[v])) touched_.push_back(v);
        off_[v] = off;
        pressure_[v] = (1.0 - b - c) * pressure[0] + b * pressure[1] + c * pressure[2];
      }
    }
  }
}

const MovingFootprint::Loaded& MovingFootprint::under(const hand::Hand& hand,
                                                      const ContactResult& contact) {
  for (const int v : touched_) off_[v] = std::numeric_limits<double>::infinity();
  touched_.clear();
  loaded_.vertex.clear();
  loaded_.pressure.clear();
  if (contact.deformed.empty() || surface_.vertices.empty()) return loaded_;
  for (const Triangle& t : hand.skin.triangles) {
    const auto& [i, j, k] = t;
    const std::array<double, 3> pressure = {contact.pressure[i], contact.pressure[j],
                                            contact.pressure[k]};
    if (!(pressure[0] > 0.0 || pressure[1] > 0.0 || pressure[2] > 0.0)) continue;
    press({contact.deformed[i], contact.deformed[j], contact.deformed[k]}, pressure);
  }
  std::sort(touched_.begin(), touched_.end());
  for (const int v : touched_) {
    if (!(pressure_[v] > 0.0)) continue;
    loaded_.vertex.push_back(v);
    loaded_.pressure.push_back(pressure_[v]);
  }
  return loaded_;
}

geometry::TriangleMesh surface_for_moving(const geometry::TriangleMesh& product,
                                          int most_triangles) {
  const double wanted =
      std::sqrt(geometry::surface_area(product) / (kSplitTriangle * most_triangles));
  for (double edge = std::max(kSkinEdge, wanted); edge <= kLongestEdge; edge *= kCoarser) {
    geometry::TriangleMesh surface = geometry::split_long_edges(product, edge);
    if (surface.triangle_count() <= most_triangles) return surface;
  }
  return product;
}

}  // namespace palmar::contact
