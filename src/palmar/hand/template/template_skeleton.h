// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/template/template_hand.h"

namespace palmar::hand {

/// Skeleton with 23 degrees of freedom from joint frames and skin in the hand frame.
///
/// Centres: the asset's joint frames (they lie 42-57 % of the finger's depth below the dorsal
/// skin). Axes: flexion of PIP, DIP, MP, IP and MCP about -x of the frame distal to the joint; they
/// lean as published axes do (little PIP here 0.90, 0.34, -0.28 radial, distal, palmar; Mirakhorlo
/// 2016 0.84, 0.28, -0.47), so that flexed fingers converge on the scaphoid. MCP abduction about
/// the axis perpendicular to flexion axis and phalanx, moving with flexion. CMC: see thumb_cmc.h.
/// Reference angles are measured between the bones of the asset; ranges are means of healthy
/// adults, widened to the reference angle where that lies outside. `source` shows both.
///
/// Throws InputError naming the frame if one is missing.
Skeleton build_skeleton(const HandAsset& asset_in_hand);

}  // namespace palmar::hand
