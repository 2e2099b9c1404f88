// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "palmar/formats/mesh/vtk.h"
#include "palmar/geometry/types.h"

namespace palmar::formats {

/// Colour as on the screen: sRGB, 0 to 255.
using VertexColour = std::array<std::uint8_t, 3>;

/// One mesh of a scene, with a colour and any number of scalars at each vertex.
struct FieldMesh {
  std::string name;
  geometry::TriangleMesh mesh;       ///< mm
  std::vector<VertexColour> colour;  ///< per vertex, or one for all, or none (light grey)
  std::vector<PointField> field;  ///< scalars; "pressure_mpa" becomes the attribute _PRESSURE_MPA
};

/// A glTF 2.0 binary scene that any viewer opens: positions in metres as glTF demands, axes as
/// they are, smooth normals, linear vertex colours, custom attributes in single precision. Meshes
/// without triangles are left out. Throws Error if colours or a field don't fit their mesh.
std::string format_glb_fields(const std::vector<FieldMesh>& meshes);

}  // namespace palmar::formats
