// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/hand/template/template_hand.h"

namespace palmar::hand {

/// Hand frame of a right hand from its joint frames: origin at the wrist joint centre; y distal,
/// from there to the MCP centre of the middle finger; x radial, along the line from the MCP of the
/// little to that of the index finger, made perpendicular to y; z = x cross y, out of the palm.
///
/// The frames know where dorsal is (their y), so a left hand or a frame turned inside out doesn't
/// slip through: throws InputError naming the joint if the fingers' dorsal directions don't point
/// to -z, the thumb doesn't lie on the radial side, or a frame is missing.
geometry::Rigid3 hand_from_asset(const HandAsset& asset);

/// The asset with skin and frames in the hand frame.
HandAsset in_hand_frame(const HandAsset& asset);

/// Frame of that name. Throws InputError naming it if the asset has none.
const geometry::Rigid3& frame_named(const HandAsset& asset, std::string_view name);

/// Name of a joint frame of a finger: (kLittle, "tip") -> "pinky-finger-tip".
std::string frame_name(Finger finger, const char* bone);

/// The skin point farthest along the finger among those within a finger's width of its distal bone.
Vec3 fingertip(const HandAsset& asset, Finger finger);

}  // namespace palmar::hand
