// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"
#include "palmar/hand/skin/drawn_creases.h"

namespace palmar::records {

/// Version of the hand files that this program writes; it reads this one and older ones.
/// Version 1 has one stiffening law per region, that of the half-space: the layered tissue and the
/// ranges then come from default_tissue().
inline constexpr int kHandFileVersion = 2;

/// A hand in a `*.hand.glb` file: glTF 2.0 binary that any viewer opens, with Palmar's data beside.
///
/// For viewers (metres, single precision): the skin with joints and weights for linear blending (an
/// approximation of eq. 2-7), attributes _SEGMENT and _REGION, one node per joint, each bone as a
/// mesh below its joint.
/// For Palmar, under `extras`: `palmar_hand_version` and `palmar_hand` with everything in double
/// precision (mm, rad); so read_hand() gives back the very value that write_hand() was given.
///
/// Throws OutputError if the file can't be written in full.
/// `creases`: where this person's were seen, kept beside the hand.
void write_hand(const std::string& path, const hand::Hand& hand,
                const hand::DrawnCreases& creases = {});

/// Throws InputError naming the file for: missing, truncated, no glTF, a glTF that is no Palmar
/// hand, a newer version than kHandFileVersion, and data that contradict themselves (counts,
/// indices, weights outside [0, 1], numbers that are not finite).
hand::Hand read_hand(const std::string& path);
/// The creases that were seen on this hand; none if nothing was written of them.
hand::DrawnCreases read_drawn_creases(const std::string& path);

/// The bytes of such a file, the same for the same hand; and back, `name` standing for the path.
std::string format_hand(const hand::Hand& hand);
hand::Hand parse_hand(const std::string& bytes, const std::string& name);

}  // namespace palmar::records
