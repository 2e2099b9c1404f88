// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "palmar/geometry/types.h"
#include "palmar/product/product_faces.h"

namespace palmar::records {

/// A mesh and the CAD faces that its triangles lie on.
struct FaceMesh {
  geometry::TriangleMesh mesh;  ///< mm
  product::ProductFaces faces;  ///< may be empty; else with a face for every triangle
};

// Compact bytes, little endian: "PalmarFM", version, counts, texts behind their length, numbers as
// doubles, CRC-32 of all of it at the end. Reading trusts nothing: counts, corners, faces of
// triangles and edges, numbers that are not finite and texts that are no UTF-8 are checked, and
// what doesn't fit throws InputError "WHAT is damaged: ...". Writing the same gives the same bytes.

/// Faces and edges without the mesh.
std::string faces_bytes(const product::ProductFaces& faces);
/// `triangles` is the number that face_of_triangle must have, if there are faces.
product::ProductFaces faces_from_bytes(std::string_view bytes, int triangles,
                                       const std::string& what);

std::string face_mesh_bytes(const FaceMesh& mesh);
FaceMesh face_mesh_from_bytes(std::string_view bytes, const std::string& what);

void write_face_mesh(const std::filesystem::path& path, const FaceMesh& mesh);
FaceMesh read_face_mesh(const std::filesystem::path& path);

}  // namespace palmar::records
