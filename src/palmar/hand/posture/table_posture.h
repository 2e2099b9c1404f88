// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "palmar/hand/posture.h"

namespace palmar::hand {

/// Heights of the five fingertips in a posture over the palm's plane, palmar positive; mm.
using FingertipHeights = std::function<std::array<double, kFingerCount>(const Posture&)>;

/// A posture with straight fingers as a table makes it of a hand placed on it, palm down: fingers
/// II to V turn in their MCP joints (Newton's method) until each tip is at the height that they
/// have in the mean; the thumb is adducted, by 40 degrees at most, until its tip is no lower.
/// Ranges of motion aren't looked at.
Posture posture_on_table(Posture posture, const FingertipHeights& height);

}  // namespace palmar::hand
