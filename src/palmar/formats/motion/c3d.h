// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/formats/motion/marker_file.h"

namespace palmar::formats {

/// Whether the first bytes are those of a C3D file.
bool is_c3d(std::string_view bytes);

/// The 3D points of a C3D file: Intel, DEC and SGI/MIPS processors; 16-bit integers times
/// POINT:SCALE, or floats; labels of POINT:LABELS, LABELS2, ...; unit of POINT:UNITS unless `unit`
/// is given. A point with a negative residual, or with a coordinate that is no number, was not
/// seen. Analog data are passed over. Reads at most what the file holds: a header that promises
/// more is noted.
///
/// Throws InputError naming file, byte and what is needed: no C3D, truncated parameters, an unknown
/// processor, no points, a unit that isn't known.
///
/// Source: Motion Lab Systems 2008, "The C3D File Format User Guide".
MarkerRecording parse_c3d(std::string_view bytes, const std::string& path,
                          std::optional<geometry::LengthUnit> unit = {});

}  // namespace palmar::formats
