// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/product_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"

namespace palmar::product {

std::string name_of(FaceKind kind) {
  switch (kind) {
    case FaceKind::kPlane:
      return "plane";
    case FaceKind::kCylinder:
      return "cylinder";
    case FaceKind::kCone:
      return "cone";
    case FaceKind::kSphere:
      return "sphere";
    case FaceKind::kTorus:
      return "torus";
    case FaceKind::kFreeform:
      break;
  }
  return "freeform";
}

std::string title_of(const ProductFace& face) {
  std::string text = "face " + std::to_string(face.number);
  if (!face.name.empty()) text += " \"" + face.name + "\"";
  text += " (" + (face.is_fillet ? "fillet" : name_of(face.kind));
  if (face.radius > 0.0) {
    char radius[32];
    std::snprintf(radius, sizeof radius, " r %.3g", face.radius);
    text += radius;
  }
  return text + ")";
}

ProductFaces scaled(const ProductFaces& faces, double factor) {
  ProductFaces result = faces;
  if (factor == 1.0) return result;
  for (ProductFace& face : result.face) {
    face.radius *= factor;
    face.area *= factor * factor;
  }
  for (ProductEdge& edge : result.edge) {
    edge.length *= factor;
    for (Vec3& point : edge.points) point *= factor;
  }
  return result;
}

void check_faces(const ProductFaces& faces, int triangles, const std::string& source) {
  const auto count = static_cast<int>(faces.face.size());
  if (static_cast<int>(faces.face_of_triangle.size()) != triangles) {
    throw InputError(source + ": " + std::to_string(faces.face_of_triangle.size()) +
                     " triangles have a face; the mesh has " + std::to_string(triangles));
  }
  for (std::size_t t = 0; t < faces.face_of_triangle.size(); ++t) {
    const int face = faces.face_of_triangle[t];
    if (face >= 0 && face < count) continue;
    throw InputError(source + ": triangle " + std::to_string(t) + " names face " +
                     std::to_string(face) + "; " + std::to_string(count) + " faces exist");
  }
  for (std::size_t e = 0; e < faces.edge.size(); ++e) {
    for (const int face : faces.edge[e].faces) {
      if (face >= -1 && face < count) continue;
      throw InputError(source + ": edge " + std::to_string(e) + " names face " +
                       std::to_string(face) + "; " + std::to_string(count) + " faces exist");
    }
  }
}

std::vector<std::array<int, 2>> border_edges(const geometry::TriangleMesh& mesh,
                                             const std::vector<int>& face_of_triangle) {
  std::vector<std::array<int, 3>> sides;  // two vertices, then the face
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corner = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corner[k], corner[(k + 1) % 3]);
      sides.push_back({low, high, face_of_triangle.at(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::array<int, 2>> borders;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const auto& [low, high, face] = sides[i];
    if (low != sides[i - 1][0] || high != sides[i - 1][1] || face == sides[i - 1][2]) continue;
    if (borders.empty() || borders.back() != std::array{low, high}) borders.push_back({low, high});
  }
  return borders;
}

}  // namespace palmar::product
