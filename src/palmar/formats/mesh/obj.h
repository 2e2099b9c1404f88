// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::formats {

/// True if the bytes are text with a vertex or face line of a Wavefront OBJ before anything else
/// that the format doesn't know.
bool is_obj(std::string_view bytes);

/// Reads vertices and faces of a Wavefront OBJ: indices from 1 or negative (counted back), texture
/// and normal indices ignored, polygons split into triangles, "\" line continuations, CRLF. Groups,
/// materials, lines and points are skipped, curves and surfaces skipped with a note. Throws
/// InputError
/// "`name`:line: ...".
///
/// Source: Wavefront Technologies, Object Files (.obj), version 3.0 of the format.
MeshFile parse_obj(std::string_view bytes, const std::string& name);

/// What an OBJ says of its surface's colours.
struct ObjColours {
  /// Vertex colours ("v x y z r g b", 0 to 1 or to 255, an extension) and places of textures;
  /// `texture` counts `material`; no images.
  geometry::SurfaceColours surface;
  std::vector<std::string> material;  ///< names, in order of first use
  std::vector<std::string> library;   ///< files that describe them (mtllib)
};
/// The same with colours.
MeshFile parse_obj(std::string_view bytes, const std::string& name, ObjColours& colours);

/// OBJ text whose numbers read back to the same doubles.
std::string format_obj(const geometry::TriangleMesh& mesh);

}  // namespace palmar::formats
