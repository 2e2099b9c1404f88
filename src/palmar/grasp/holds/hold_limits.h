// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace palmar::grasp {

/// Length over diameter of a bar: shorter ones are knobs. Choice.
inline constexpr double kStubShare = 1.8;
/// Hand lengths that thumb and fingers hold between them. Choice.
inline constexpr double kHandSpan = 0.55;

/// Such a difference of two holds' scores doesn't change their order. Choice.
inline constexpr double kNearTie = 0.2;

/// Of the four fingers' breadth that go through a loop at least: two fingers.
inline constexpr double kFewestFingers = 0.45;

/// 0 at `none` and beyond, 1 at `all` and beyond, smoothly between.
inline double smooth_step(double value, double none, double all) {
  const double t = std::clamp((value - none) / (all - none), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace palmar::grasp
