// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palmar::grasp {

/// Length over diameter of a bar: shorter ones are knobs. Choice.
inline constexpr double kStubShare = 1.8;
/// Hand lengths that thumb and fingers hold between them. Choice.
inline constexpr double kHandSpan = 0.55;

/// Such a difference of two holds' scores doesn't change their order. Choice.
inline constexpr double kNearTie = 0.2;

}  // namespace palmar::grasp
