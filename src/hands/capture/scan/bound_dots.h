// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/scan/skin_marks.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skin/hand_points.h"

namespace palmar::capture {

/// A dot of the reference scan and where its skin carries it.
struct BoundDot {
  Vec3 point = Vec3::Zero();  ///< hand frame, reference posture, mm
  hand::HandPoint on_hand;
  hand::Segment segment{};  ///< that it was drawn on; on the back of the hand: palm
  /// On a proximal phalanx so near the knuckle that its skin is the palm's: it slides between both
  /// and shows the motion of neither.
  bool slides = false;
};

/// Dots of the reference scan with what they were drawn on: what somebody said, else the segment of
/// the skin under them. Skin over the proximal phalanges of II to V belongs to the palm as far as
/// their base creases, which lie some 20 mm distal of the knuckles on the palmar side; on the back
/// that is the phalanx already, from 5 mm distal of its joint.
std::vector<BoundDot> bind_dots(const hand::Hand& hand, const SkinMarks& marks,
                                const geometry::Rigid3& hand_from_scan);

}  // namespace palmar::capture
