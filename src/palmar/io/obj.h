// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/io/mesh_file.h"

namespace palmar {

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

/// OBJ text whose numbers read back to the same doubles.
std::string format_obj(const TriangleMesh& mesh);

}  // namespace palmar
