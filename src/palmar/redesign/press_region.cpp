// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/press_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "palmar/core/parallel.h"
#include "palmar/geometry/closest_point.h"
#include "palmar/geometry/mesh_measures.h"
#include "palmar/geometry/split_edges.h"

namespace palmar {
namespace {

constexpr double kCell = 2.0;  // mm; marks nearer than that to each other serve as one
// Vertices of a skin are about 2.5 mm apart: an edge of the product can lie between them.
constexpr double kNear = 1.5;   // mm
constexpr double kDeep = 10.0;  // mm; what is deeper has neighbours that are less deep

using Cell = std::array<int, 3>;

/// Cells of the product's surface above vertices of one skin that are in or at the product.
std::vector<Cell> cells_under(const Product& product, const TriangleMesh& skin) {
  Box3 box = product.distance->bounding_box();
  box.min().array() -= kNear;
  box.max().array() += kNear;
  std::vector<Vec3> points;
  for (const Vec3& x : skin.vertices) {
    if (box.contains(x)) points.push_back(x);
  }
  std::vector<DistanceSample> samples(points.size());
  product.distance->sample(points, kDeep, samples);
  std::vector<Cell> cells;
  for (const DistanceSample& s : samples) {
    if (s.triangle < 0 || s.distance > kNear) continue;
    cells.push_back({static_cast<int>(std::floor(s.closest.x() / kCell)),
                     static_cast<int>(std::floor(s.closest.y() / kCell)),
                     static_cast<int>(std::floor(s.closest.z() / kCell))});
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Centres of the cells under any skin, as a mesh of triangles without extent.
TriangleMesh marks_under(const Product& product, std::span<const TriangleMesh> skins) {
  std::vector<std::vector<Cell>> cells(skins.size());
  parallel_for(static_cast<int>(skins.size()), [&](int k) {
    const auto i = static_cast<std::size_t>(k);
    cells[i] = cells_under(product, skins[i]);
  });
  std::vector<Cell> all;
  for (const auto& some : cells) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  TriangleMesh marks;
  for (const Cell& c : all) {
    const int v = marks.vertex_count();
    marks.vertices.emplace_back((c[0] + 0.5) * kCell, (c[1] + 0.5) * kCell, (c[2] + 0.5) * kCell);
    marks.triangles.push_back({v, v, v});
  }
  return marks;
}

std::vector<int> triangles_below(const TriangleMesh& original, const TriangleMesh& fine) {
  std::vector<int> below(fine.triangles.size());
  const ClosestPointQuery query(original);
  parallel_for(fine.triangle_count(), [&](int t) {
    const Triangle& corner = fine.triangles[static_cast<std::size_t>(t)];
    const Vec3 centre = (fine.vertices[static_cast<std::size_t>(corner[0])] +
                         fine.vertices[static_cast<std::size_t>(corner[1])] +
                         fine.vertices[static_cast<std::size_t>(corner[2])]) /
                        3.0;
    below[static_cast<std::size_t>(t)] = query.closest(centre)->triangle;
  });
  return below;
}

}  // namespace

PressRegion refine_under(const Product& product, std::span<const TriangleMesh> skins,
                         double edge_length, double margin) {
  PressRegion region;
  const TriangleMesh marks = marks_under(product, skins);
  if (marks.triangles.empty()) {
    region.mesh = product.mesh;
    region.triangle_of.resize(region.mesh.triangles.size());
    std::iota(region.triangle_of.begin(), region.triangle_of.end(), 0);
    return region;
  }
  const ClosestPointQuery query(marks);
  const double reach = margin + std::sqrt(3.0) / 2.0 * kCell;
  // Within the circle round the centroid: careful for large triangles, which get smaller.
  const TriangleChoice is_near = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 centre = (a + b + c) / 3.0;
    const double radius = std::sqrt(std::max(
        {(a - centre).squaredNorm(), (b - centre).squaredNorm(), (c - centre).squaredNorm()}));
    return query.closest(centre, reach + radius).has_value();
  };
  region.mesh = split_long_edges(product.mesh, edge_length, is_near);
  region.triangle_of = triangles_below(product.mesh, region.mesh);

  std::vector<int> part_of(region.mesh.vertices.size(), -1);
  for (int t = 0; t < region.mesh.triangle_count(); ++t) {
    const Triangle& corner = region.mesh.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](int k) {
      return region.mesh.vertices[static_cast<std::size_t>(corner[static_cast<std::size_t>(k)])];
    };
    if (!is_near(at(0), at(1), at(2))) continue;
    region.part_triangle.push_back(t);
    for (const int v : corner) part_of[static_cast<std::size_t>(v)] = 0;
  }
  for (int v = 0; v < region.mesh.vertex_count(); ++v) {
    int& place = part_of[static_cast<std::size_t>(v)];
    if (place < 0) continue;
    place = static_cast<int>(region.part_vertex.size());
    region.part_vertex.push_back(v);
    region.part.vertices.push_back(region.mesh.vertices[static_cast<std::size_t>(v)]);
  }
  for (const int t : region.part_triangle) {
    const Triangle& corner = region.mesh.triangles[static_cast<std::size_t>(t)];
    region.part.triangles.push_back({part_of[static_cast<std::size_t>(corner[0])],
                                     part_of[static_cast<std::size_t>(corner[1])],
                                     part_of[static_cast<std::size_t>(corner[2])]});
  }
  return region;
}

}  // namespace palmar
