// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// Names of the stored postures: flat, relaxed, spread, fist, point, thumb_to_little, key_pinch,
/// tip_pinch, tripod, cylinder_grip.
std::vector<std::string> posture_names();

/// A stored posture, held to the skeleton's range of motion; nothing for an unknown name. Angles of
/// abduction are stored as departures from the reference posture, the others as anatomical angles.
/// Those of the grips were chosen so that the pads concerned meet on the template hand.
std::optional<Posture> named_posture(const Skeleton& skeleton, std::string_view name);

}  // namespace palmar::hand
