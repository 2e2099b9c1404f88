// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/formats/mesh/mesh_file.h"

namespace palmar::formats {

/// Reads a 3MF package: every object that the build section places, with the transforms of build
/// items and components, joined into one mesh (a note says of how many). Objects in other parts of
/// the package (production extension) are found too. The unit comes from the model; micron and foot
/// are turned into mm and inch. Colours, materials, slices and beam lattices are skipped. Throws
/// InputError "`name`..." naming the part and its line.
///
/// Source: 3MF Consortium, 3MF Core Specification 1.3, sections 2 to 4; Production Extension 1.1.
MeshFile parse_three_mf(std::string_view bytes, const std::string& name);

}  // namespace palmar::formats
