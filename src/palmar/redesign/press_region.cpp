// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/press_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/editable_mesh.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/redesign/even_patches.h"

namespace palmar::redesign {
namespace {

constexpr double kCell = 2.0;  // mm; marks nearer than that to each other serve as one
// Vertices of a skin are about 2.5 mm apart: an edge of the product can lie between them.
constexpr double kNear = 1.5;  // mm
constexpr double kBorderShare = 0.8;
constexpr double kDeep = 10.0;  // mm; what is deeper has neighbours that are less deep

using Cell = std::array<int, 3>;

// Rounding, not floor: a mirrored hand marks mirrored cells.
/// Cells of the product's surface above vertices of one skin that are in or at the product.
std::vector<Cell> cells_under(const product::Product& product, const geometry::TriangleMesh& skin) {
  Box3 box = product.distance->bounding_box();
  box.min().array() -= kNear;
  box.max().array() += kNear;
  std::vector<Vec3> points;
  for (const Vec3& x : skin.vertices) {
    if (box.contains(x)) points.push_back(x);
  }
  std::vector<geometry::DistanceSample> samples(points.size());
  product.distance->sample(points, kDeep, samples);
  std::vector<Cell> cells;
  for (const geometry::DistanceSample& s : samples) {
    if (s.distance > kNear || s.distance <= -kDeep) continue;
    cells.push_back({static_cast<int>(std::lround(s.closest.x() / kCell)),
                     static_cast<int>(std::lround(s.closest.y() / kCell)),
                     static_cast<int>(std::lround(s.closest.z() / kCell))});
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Centres of the cells under any skin, as a mesh of triangles without extent.
geometry::TriangleMesh marks_under(const product::Product& product,
                                   std::span<const geometry::TriangleMesh> skins) {
  std::vector<std::vector<Cell>> cells(skins.size());
  parallel_for(static_cast<int>(skins.size()),
               [&](int k) { cells[k] = cells_under(product, skins[k]); });
  std::vector<Cell> all;
  for (const auto& some : cells) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  geometry::TriangleMesh marks;
  for (const Cell& c : all) {
    const int v = marks.vertex_count();
    marks.vertices.emplace_back(c[0] * kCell, c[1] * kCell, c[2] * kCell);
    marks.triangles.push_back({v, v, v});
  }
  return marks;
}

/// Whether the edge of two triangles in one plane is the wrong diagonal: the angles that face it
/// sum to more than 180 degrees (Delaunay), and the other one lies within them, too.
bool is_wrong_diagonal(const geometry::EditableMesh& mesh, int h, double edge_length) {
  const int twin = mesh.twin(h);
  if (twin < 0 || h > twin) return false;
  const Vec3& a = mesh.position(mesh.start(h));
  const Vec3& b = mesh.position(mesh.end(h));
  const Vec3& c = mesh.position(mesh.apex(h));
  const Vec3& d = mesh.position(mesh.apex(twin));
  // What is larger than split triangles are is left as it was.
  if ((a - b).norm() > edge_length || (c - d).norm() > edge_length) return false;
  const Vec3 n = (b - a).cross(c - a);
  const Vec3 m = (a - b).cross(d - b);
  const double flat = 1e-12 * edge_length * edge_length;
  if (n.norm() <= flat || m.norm() <= flat || n.dot(m) < (1.0 - 1e-12) * n.norm() * m.norm()) {
    return false;
  }
  const double c_cot = (a - c).dot(b - c) / n.norm();
  const double d_cot = (a - d).dot(b - d) / m.norm();
  if (!(c_cot + d_cot < -1e-9)) return false;
  const Vec3 up = n.normalized();
  return (d - c).cross(b - c).dot(up) > flat && (c - d).cross(a - d).dot(up) > flat;
}

/// Turns wrong diagonals; the surface and its vertices stay. Smoothing needs triangles that aren't
/// needles for no reason. A mesh that isn't 2-manifold stays as it is.
geometry::TriangleMesh with_turned_diagonals(geometry::TriangleMesh mesh, double edge_length) {
  constexpr int kMaxRounds = 50;
  try {
    geometry::EditableMesh editable(mesh);
    for (int round = 0; round < kMaxRounds; ++round) {
      bool has_turned = false;
      for (int h = 0; h < editable.half_edge_capacity(); ++h) {
        if (!editable.has_half_edge(h) || !is_wrong_diagonal(editable, h, edge_length)) continue;
        has_turned = editable.flip(h) || has_turned;
      }
      if (!has_turned) break;
    }
    geometry::EditableMesh::Compacted result = editable.compacted();
    if (result.mesh.vertices.size() == mesh.vertices.size()) return std::move(result.mesh);
  } catch (const InputError&) {
    // Not 2-manifold.
  }
  return mesh;
}

std::vector<int> triangles_below(const geometry::TriangleMesh& original,
                                 const geometry::TriangleMesh& fine) {
  std::vector<int> below(fine.triangles.size());
  const geometry::ClosestPointQuery query(original);
  parallel_for(fine.triangle_count(), [&](int t) {
    const Triangle& corner = fine.triangles[t];
    const Vec3 centre =
        (fine.vertices[corner[0]] + fine.vertices[corner[1]] + fine.vertices[corner[2]]) / 3.0;
    below[t] = query.closest(centre)->triangle;
  });
  return below;
}

}  // namespace

PressRegion refine_under(const product::Product& product,
                         std::span<const geometry::TriangleMesh> skins, double edge_length,
                         double margin) {
  PressRegion region;
  const geometry::TriangleMesh marks = marks_under(product, skins);
  if (marks.triangles.empty()) {
    region.mesh = product.mesh;
    region.triangle_of.resize(region.mesh.triangles.size());
    std::iota(region.triangle_of.begin(), region.triangle_of.end(), 0);
    return region;
  }
  const geometry::ClosestPointQuery query(marks);
  const double reach = margin + std::sqrt(3.0) / 2.0 * kCell;
  // Within the circle round the centroid: careful for large triangles, which get smaller.
  const geometry::TriangleChoice is_near = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 centre = (a + b + c) / 3.0;
    const double radius = std::sqrt(std::max(
        {(a - centre).squaredNorm(), (b - centre).squaredNorm(), (c - centre).squaredNorm()}));
    return query.closest(centre, reach + radius).has_value();
  };
  // What CAD programs mesh for itself are long slivers: all of it is made anew. Of a scan the rest
  // stays.
  const bool is_cad = product.faces != nullptr;
  const geometry::TriangleChoice is_made = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return is_cad || is_near(a, b, c);
  };
  // Borders of patches stay as they are split here: clearly shorter than what is made between them.
  const double split = kBorderShare * edge_length;
  region.mesh =
      with_turned_diagonals(geometry::split_long_edges(product.mesh, split, is_made), split);
  // A triangle lies in one CAD face.
  const std::vector<int> below = triangles_below(product.mesh, region.mesh);
  std::vector<int> group(region.mesh.triangles.size(), -1);
  for (int t = 0; t < region.mesh.triangle_count(); ++t) {
    const Triangle& corner = region.mesh.triangles[t];
    const auto at = [&](int k) { return region.mesh.vertices[corner[k]]; };
    if (!is_made(at(0), at(1), at(2))) continue;
    group[t] = !is_cad ? 0 : std::max(0, product.faces->face_of_triangle[below[t]]);
  }
  region.mesh = with_even_patches(region.mesh, group, edge_length);
  region.triangle_of = triangles_below(product.mesh, region.mesh);

  std::vector<int> part_of(region.mesh.vertices.size(), -1);
  for (int t = 0; t < region.mesh.triangle_count(); ++t) {
    const Triangle& corner = region.mesh.triangles[t];
    const auto at = [&](int k) { return region.mesh.vertices[corner[k]]; };
    if (!is_near(at(0), at(1), at(2))) continue;
    region.part_triangle.push_back(t);
    for (const int v : corner) part_of[v] = 0;
  }
  for (int v = 0; v < region.mesh.vertex_count(); ++v) {
    int& place = part_of[v];
    if (place < 0) continue;
    place = static_cast<int>(region.part_vertex.size());
    region.part_vertex.push_back(v);
    region.part.vertices.push_back(region.mesh.vertices[v]);
  }
  for (const int t : region.part_triangle) {
    const Triangle& corner = region.mesh.triangles[t];
    region.part.triangles.push_back({part_of[corner[0]], part_of[corner[1]], part_of[corner[2]]});
  }
  return region;
}

}  // namespace palmar::redesign
