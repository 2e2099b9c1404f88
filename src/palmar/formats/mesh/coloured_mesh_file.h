// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::formats {

/// A surface with its colours, in the file's own unit.
struct ColouredMeshFile {
  MeshFile shape;
  geometry::SurfaceColours colours;  ///< empty if the file has none
};

/// Reads a scan: OBJ (vertex colours, or textures by its material file), PLY (vertex colours), GLB
/// and glTF (textures, COLOR_0); other meshes as read_mesh() does, without colours. Textures are
/// PNG or JPEG in the mesh's own folder or inside the file; one that is missing or damaged is an
/// InputError that names it.
ColouredMeshFile read_coloured_mesh(const std::filesystem::path& path);

/// Writes a .ply with vertex colours, coordinates as they are.
void write_coloured_mesh(const std::filesystem::path& path, const geometry::ColouredMesh& mesh);

/// Writes an .obj with its material file and texture beside it (same name, .mtl and .png).
/// `colours` holds one texture that all triangles use; throws UsageError otherwise, OutputError.
void write_textured_mesh(const std::filesystem::path& path, const geometry::TriangleMesh& mesh,
                         const geometry::SurfaceColours& colours);

}  // namespace palmar::formats
