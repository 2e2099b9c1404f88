// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::formats {

/// Numbers at the vertices of a mesh.
struct PointField {
  std::string name;           ///< with its unit: "pressure_mpa"
  std::vector<double> value;  ///< vertex count x components, vertex by vertex
  int components = 1;
};

/// A field of one vector per vertex.
PointField vector_field(const std::string& name, const std::vector<Vec3>& vectors);

/// A line of text that belongs to the whole mesh: what made it, with which settings.
struct MeshNote {
  std::string name, text;
};

/// A VTK PolyData file (.vtp, XML, version 1.0): points in mm, triangles, point data in double
/// precision, base64 behind the XML part; opens in ParaView. The first field is the active scalar.
/// Notes become field data (strings).
/// Throws Error if a field doesn't fit the mesh (names field and sizes).
///
/// Source: Kitware, VTK File Formats for VTK 4.2 (XML file formats, appended data).
std::string format_vtp(const geometry::TriangleMesh& mesh, const std::vector<PointField>& fields,
                       const std::vector<MeshNote>& notes = {});

/// Base64 with padding (RFC 4648, section 4).
std::string base64(std::string_view bytes);

}  // namespace palmar::formats
