// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/io/mesh_file.h"

namespace palmar {

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

/// Binary little-endian PLY in double precision.
std::string format_ply(const TriangleMesh& mesh);

}  // namespace palmar
