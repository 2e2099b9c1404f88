// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/surface_change.h"

#include <algorithm>

#include "palmar/cad/model/tessellation.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/remesh/split_edges.h"

namespace palmar::cad {
namespace {

constexpr double kChordalError = 0.02;  // mm; a fifth of what a machinist is asked to keep
constexpr double kAngle = 0.1;          // rad

double largest_distance(const geometry::TriangleMesh& from, const geometry::TriangleMesh& to) {
  const geometry::ClosestPointQuery query(to);
  double largest = 0.0;
  std::optional<int> hint;
  for (const Vec3& vertex : from.vertices) {
    const std::optional<geometry::ClosestPoint> near =
        query.closest(vertex, std::numeric_limits<double>::infinity(), hint);
    if (!near) continue;
    hint = near->triangle;
    largest = std::max(largest, near->distance);
  }
  return largest;
}

double size_of(const geometry::TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

}  // namespace

SurfaceChange surface_change(const CadModel& before, const CadModel& after,
                             const std::vector<int>& faces) {
  const TessellationOptions options{.chordal_error = kChordalError, .angle = kAngle};
  const Tessellation old = tessellate(before, options), now = tessellate(after, options);
  const double step = std::clamp(size_of(old.mesh) / 50, 0.5, 3.0);
  SurfaceChange change;
  change.largest = std::max(largest_distance(geometry::split_long_edges(old.mesh, step), now.mesh),
                            largest_distance(geometry::split_long_edges(now.mesh, step), old.mesh));
  if (!faces.empty()) {
    geometry::TriangleMesh part;
    part.vertices = old.mesh.vertices;
    for (size_t i = 0; i < old.mesh.triangles.size(); ++i) {
      const int number = old.faces.face[old.faces.face_of_triangle[i]].number;
      if (std::find(faces.begin(), faces.end(), number) != faces.end()) {
        part.triangles.push_back(old.mesh.triangles[i]);
      }
    }
    geometry::TriangleMesh dense = geometry::split_long_edges(part, step);
    // Only points of these triangles count; the others are left over from the whole mesh.
    std::vector<bool> is_used(dense.vertices.size(), false);
    for (const auto& triangle : dense.triangles) {
      for (const int corner : triangle) is_used[corner] = true;
    }
    geometry::TriangleMesh points;
    for (size_t i = 0; i < dense.vertices.size(); ++i) {
      if (is_used[i]) points.vertices.push_back(dense.vertices[i]);
    }
    change.of_faces = largest_distance(points, now.mesh);
  }
  return change;
}

}  // namespace palmar::cad
