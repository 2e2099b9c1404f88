// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"

namespace palmar {

/// What `palmar hand info --json` prints: dimensions in mm, joints with centre, axis and range of
/// motion in degrees, sources, provenance.
std::string hand_info_json(const Hand& hand);

}  // namespace palmar
