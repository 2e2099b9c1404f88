// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// A model hand brought near to a person's: sized, and posed.
struct PosedModel {
  hand::Hand sized;  ///< in its own reference posture
  hand::Posture posture;
  geometry::Rigid3 scan_from_hand;  ///< from the sized hand's frame to that of the person's joints
  double joint_miss = 0.0;          ///< mean distance of joint centres and fingertips, mm
};

/// Makes the segments of `model` as long as the links between the joints of `skeleton`, the palm as
/// long and as broad as the way to and between its MCP joints, and looks for the posture in which
/// joint centres, fingertips and flexion axes lie nearest to those of `skeleton`. Wrist angles,
/// which joints of the hand don't show, stay at the model's reference.
PosedModel posed_model(const hand::Hand& model, const hand::Skeleton& skeleton);

/// Skin of a posed model in the frame of the person's joints, mm. What joints miss in the posture
/// (a palm of other proportions) is made up for smoothly: each joint lands where the person's is.
std::vector<Vec3> skin_at(const PosedModel& model, const hand::Skeleton& skeleton);

/// Bones likewise, in the order of the model's.
std::vector<geometry::TriangleMesh> bones_at(const PosedModel& model,
                                             const hand::Skeleton& skeleton);

}  // namespace palmar::capture
