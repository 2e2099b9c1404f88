// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/template/template_hand.h"

namespace palmar::hand {

/// Share of the distal link in the way from PIP (thumb: MP) joint to fingertip.
double published_distal_share(Finger finger);
/// Length of the thumb's metacarpal link, CMC to MP joint, over the way from MP joint to fingertip.
double published_thumb_metacarpal();

/// The asset with its joint frames moved to published proportions where it departs from them most:
/// its DIP joints stand 1-3 mm too far proximal, the IP joint of the thumb 2 mm too far distal, and
/// the CMC joint 11 mm too far distal (on the shaft of the metacarpal).
///
/// - DIP (thumb: IP) parts the way from PIP (MP) to the fingertip by published_distal_share(). It
///   keeps its share of the finger's depth and breadth, measured in the plane across the finger.
/// - CMC moves along the metacarpal until that has its published length.
/// - MCP, PIP and MP stay; directions of all frames stay, and with them the joints' axes.
///
/// Proportions are the means of two sources, which differ by 3 mm at the DIP joints: joint centres
/// of Buchholz, Armstrong & Goldstein 1992 (Ergonomics 35:261-273) and radiographs of Buryanov &
/// Kotiuk 2010 (Int J Morphol 28:755-758; bone lengths, at the tip with the soft tissue).
///
/// Throws InputError if a frame is missing or the skin has no section at a joint.
HandAsset with_published_links(const HandAsset& asset_in_hand);

}  // namespace palmar::hand
