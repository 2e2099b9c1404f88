// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::formats {

/// True if the bytes start as a PLY file does.
bool is_ply(std::string_view bytes);

/// Reads vertices (x, y, z of any number type, in any order among other properties) and faces
/// (vertex_indices or vertex_index; polygons are split) of a PLY file: ascii, binary_little_endian
/// or binary_big_endian, version 1.0. Other elements and properties (colours, normals, quality) are
/// skipped. Throws InputError "`name`: ..." naming the header line, or the element and the byte or
/// line where the data end too early.
///
/// Source: Turk, The PLY Polygon File Format, Stanford, 1994.
MeshFile parse_ply(std::string_view bytes, const std::string& name);
/// The same with the colours of the vertices (red, green, blue; whole numbers to 255 or fractions
/// to 1), if it has any, and with them which were seen: property measured (0: a guess), else views
/// (less than 2).
MeshFile parse_ply(std::string_view bytes, const std::string& name,
                   geometry::SurfaceColours& colours);

/// Binary little-endian PLY in double precision.
std::string format_ply(const geometry::TriangleMesh& mesh);
/// The same with a colour of every vertex in bytes, as other programs read it.
std::string format_ply(const geometry::ColouredMesh& mesh);
/// The same with more properties of the vertices, a byte each.
struct PlyByteProperty {
  std::string name;
  std::vector<std::uint8_t> value;  ///< per vertex
};
std::string format_ply(const geometry::ColouredMesh& mesh,
                       const std::vector<PlyByteProperty>& properties);

}  // namespace palmar::formats
