// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::report {

// Meshes and fields for the study's 3-D view, small: quantised, as differences between neighbours,
// deflated (zlib, RFC 1950; browsers have DecompressionStream), in base64. For display only.

/// Places [mm] in whole steps of kPositionStep from the box's lower corner: {"low": [x, y, z],
/// "step": mm, "data": "..."}; data holds, for x, then y, then z, the high bytes of all zigzag
/// differences (uint16) to the vertex before, then their low bytes. A mesh too large for 65535
/// steps gets larger ones.
inline constexpr double kPositionStep = 0.02;  // mm
std::string packed_positions(std::span<const Vec3> places);

/// 3 per triangle, as int32 little-endian differences to the corner before.
std::string packed_triangles(std::span<const Triangle> triangles);

/// The same for any whole numbers: int32 differences to the one before.
std::string packed_numbers(std::span<const int> numbers);

/// Values as shares of `upper` in 255 steps, one byte each; what is above has the colour of the
/// end.
std::string packed_shares(std::span<const double> values, double upper);

}  // namespace palmar::report
