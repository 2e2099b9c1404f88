// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/formats/mesh/glb.h"
#include "palmar/hand/hand.h"

namespace palmar::records {

/// The glTF scene of a hand for viewers: metres, single precision. One node per joint (at its
/// centre, axes of the hand frame), the skin bound to them by linear blending, bones below their
/// joints. For use inside `io` only.
///
/// Linear-blend weights from the angles' weights p_j = w1_j w2_j: along a chain of joints, the body
/// distal to joint j gets p_j less the p of the next joint, the palm what is left; the four largest
/// are kept and made to sum to 1.
formats::Glb make_hand_scene(const hand::Hand& hand);

}  // namespace palmar::records
