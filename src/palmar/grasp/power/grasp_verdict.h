// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "palmar/grasp/grasp.h"
#include "palmar/grasp/power/closing.h"
#include "palmar/grasp/power/grip_axis.h"

namespace palmar::grasp {

using Touching = std::array<bool, hand::kSegmentCount>;  ///< by segment: whether its skin touches

/// "held by four fingers; the tip of the little finger does not touch".
std::string held_words(const Touching& touches, Grip grip);

/// What stopped every segment once the hand is closed, from `measure` and the reasons that closing
/// left in grasp.stops.
void finish_stops(const HoldMeasure& measure, const DepthLimits& limits, Grasp& grasp);

/// Status and message of a closed hand: contacts hold from opposite sides if no gap between them
/// round the axis exceeds half a turn by more than two friction angles of 30 degrees.
void judge_hold(const hand::Hand& hand, const HoldMeasure& measure, const GripSite& site,
                Grasp& grasp);

/// Status and message of a shape that skin can't be closed on, reported before trying. False: it
/// can.
bool is_out_of_reach(const GripSite& site, const PowerGraspOptions& options, Grasp& grasp);

}  // namespace palmar::grasp
