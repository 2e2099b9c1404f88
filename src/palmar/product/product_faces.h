// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::product {

/// What surface a face of a CAD model lies on.
enum class FaceKind { kPlane, kCylinder, kCone, kSphere, kTorus, kFreeform };
std::string name_of(FaceKind kind);  ///< "plane", "cylinder", ..., "freeform"

/// One face of a CAD model, as its designer knows it.
struct ProductFace {
  int number = 0;    ///< from 1, in the order of the file; the same after STEP was written and read
  std::string name;  ///< from the file; "" if it has none
  std::string
      part;  ///< solid it belongs to, with the assembly's path: "drill / handle"; "" if none
  FaceKind kind = FaceKind::kFreeform;
  /// mm; of a cylinder or a sphere, of the section of a torus; 0 of other kinds.
  double radius = 0.0;
  bool is_concave = false;  ///< material lies outside of the radius: a hole, a groove
  /// Convex or concave blend: meets the faces on both of its long sides without an edge.
  bool is_fillet = false;
  double area = 0.0;                           ///< mm^2
  std::optional<std::array<float, 3>> colour;  ///< sRGB, 0 to 1
};
/// For people: "face 12 (fillet r 3)", "face 4 (plane)", "face 7 \"grip\" (cylinder r 16)".
std::string title_of(const ProductFace& face);

/// One edge between faces of a CAD model.
struct ProductEdge {
  int number = 0;                       ///< from 1, as faces
  std::array<int, 2> faces = {-1, -1};  ///< indices into ProductFaces::face; -1: none (free edge)
  bool is_convex = false;               ///< the material's angle is below 180 degrees
  bool is_smooth = false;               ///< faces meet without a kink (below 1 degree)
  double angle = 0.0;                   ///< rad; between the faces' normals at its middle
  double length = 0.0;                  ///< mm
  std::vector<Vec3> points;             ///< along it, product frame, mm
};

/// Faces and edges of a product that came from CAD, and which of its triangles lie on which face.
struct ProductFaces {
  std::vector<ProductFace> face;
  std::vector<ProductEdge> edge;
  std::vector<int> face_of_triangle;  ///< index into `face`, per triangle of the mesh
};

/// All lengths times `factor`: for units and sizes of a product.
ProductFaces scaled(const ProductFaces& faces, double factor);

/// Throws InputError unless every triangle of a mesh of `triangles` has a face, and edges name
/// faces that exist; `source` stands in front of the message.
void check_faces(const ProductFaces& faces, int triangles, const std::string& source);

/// Edges of a mesh where triangles of different faces meet: pairs of vertices, ascending. For
/// drawing; ProductFaces::edge are those that the designer knows.
std::vector<std::array<int, 2>> border_edges(const geometry::TriangleMesh& mesh,
                                             const std::vector<int>& face_of_triangle);

}  // namespace palmar::product
