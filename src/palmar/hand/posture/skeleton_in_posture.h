// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// The skeleton with joints, axes and fingertips where they are in a posture, which becomes its
/// reference posture: pose_skeleton() of the result by any angles is what it was before, seen from
/// there (the thumb's CMC joint: exactly at the reference and at its limits). The palm, and with it
/// the hand frame, stays. Ranges that don't hold the posture are widened to it.
Skeleton skeleton_in_posture(const Skeleton& skeleton, const Posture& posture);

}  // namespace palmar::hand
