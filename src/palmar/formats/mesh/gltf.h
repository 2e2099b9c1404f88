// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::formats {

/// Reads the triangles of the default scene of a glTF 2.0 file, text (.gltf, with embedded or
/// neighbouring buffers) or binary (.glb): node transforms applied, strips and fans unrolled,
/// corners with identical positions merged (glTF splits them at seams). Unit: metre, as glTF says.
/// Points, lines, cameras and materials are skipped; a skin or morph target stays at rest, with a
/// note. Throws InputError naming the file and the place in its JSON; compressed meshes (Draco,
/// meshopt) and sparse accessors are refused by name.
///
/// Source: Khronos, glTF 2.0 specification, sections 3.5 to 3.7 and 4.4.
MeshFile parse_gltf(std::string_view bytes, const std::filesystem::path& path);

/// The same with its colours: base colour textures (images as they are coded in the file, read by
/// read_texture()), and COLOR_0, which glTF stores linear, as sRGB.
MeshFile parse_gltf(std::string_view bytes, const std::filesystem::path& path,
                    geometry::SurfaceColours& colours);

}  // namespace palmar::formats
