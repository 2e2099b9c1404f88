// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/formats/mesh/mesh_file.h"

namespace palmar::formats {

/// True if the bytes are an STL file beyond doubt: the length fits the binary triangle count, or
/// text that starts with "solid" and goes on with a facet or an end.
bool is_stl(std::string_view bytes);

/// Reads binary or ASCII STL; distinguished by length, since binary files may start with "solid"
/// too. Corners with identical coordinates become one vertex; stored normals are not used. Throws
/// InputError "`name`: ..." naming the facet (from 1), the line, or the bytes expected and found.
///
/// Source: 3D Systems, StereoLithography Interface Specification, 1989 (80-byte header, 32-bit
/// count, 50 bytes per facet, little-endian).
MeshFile parse_stl(std::string_view bytes, const std::string& name);

/// Binary STL; coordinates are rounded to single precision, as the format demands.
std::string format_stl(const geometry::TriangleMesh& mesh);

}  // namespace palmar::formats
