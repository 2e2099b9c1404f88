// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace palmar::geometry {

/// Angles are radians inside; degrees stand at the boundary (files, options, tables) and in
/// constants that people read: 25.0 * kDegree.
inline constexpr double kDegree = std::numbers::pi / 180.0;            ///< rad
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;  ///< 1 / rad

}  // namespace palmar::geometry
