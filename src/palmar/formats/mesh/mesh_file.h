// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/types.h"

namespace palmar::formats {

/// A mesh as it stands in a file: coordinates in the file's own unit, not yet mm.
///
/// At least one triangle; every coordinate is finite and at most 1e12; no triangle names a vertex
/// twice; every vertex belongs to a triangle. Nothing else is promised: it may be open, flipped or
/// self-crossing.
struct MeshFile {
  geometry::TriangleMesh mesh;               ///< in the file's unit
  std::optional<geometry::LengthUnit> unit;  ///< if the format carries it (3MF, glTF)
  std::string format;              ///< "binary STL", "OBJ", "PLY (ascii)", "3MF", "glTF binary" ...
  std::vector<std::string> notes;  ///< what was skipped, dropped or doubted, with counts
};

/// Largest mesh that is read.
inline constexpr int kMaxTriangles = 50'000'000;

/// Reads STL (binary, ASCII), OBJ, PLY (ascii, both binary byte orders), 3MF, glTF and GLB. What
/// the file holds decides, not its name; a contradiction is noted. Throws InputError naming the
/// file, the place in it (line, facet, byte) and what was expected.
MeshFile read_mesh(const std::filesystem::path& path);

/// Writes by extension: .stl (binary, single precision), .obj (text that reads back exactly) or
/// .ply (binary little-endian, double precision). Coordinates are written as they are, in mm: none
/// of the three formats carries a unit. Throws UsageError on another extension, OutputError.
void write_mesh(const std::filesystem::path& path, const geometry::TriangleMesh& mesh);

}  // namespace palmar::formats
