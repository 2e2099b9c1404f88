// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/product/product.h"

namespace palmar::person_workflow {

/// A scan made ready to look for a hand in.
struct ReadSurface {
  geometry::ColouredMesh surface;  ///< mm; the largest piece that is no table, oriented outwards;
                                   ///< colours may be empty
  geometry::LengthUnit unit = geometry::LengthUnit::kMillimetre;
  std::vector<std::string> notes;  ///< "FILE: ..."
};

/// Reads a scan. The unit is `unit`, else the file's, else the only one that makes it
/// as long as a hand with or without a forearm (140 to 480 mm). Throws InputError naming the file,
/// its extent and the setting "unit" if none or several do, or if a unit that was stated doesn't.
ReadSurface read_scan_surface(const std::string& path, std::optional<geometry::LengthUnit> unit);

/// Mean colour within a millimetre of a point given in the file's own coordinates and unit. Throws
/// UsageError naming `setting`, InputError if the scan has no colours.
geometry::Srgb colour_near(const ReadSurface& scan, const std::string& setting, const Vec3& point);

}  // namespace palmar::person_workflow
