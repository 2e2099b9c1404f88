// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/grasp/hold_value.h"

namespace palmar::records {

/// Version of the hold files that this program writes; a newer one is refused.
inline constexpr int kHoldFileVersion = 1;

/// How a product is held, as a TOML file that people can read and edit (docs/using/holds.md).
///
///     version = 1
///     product = "mug"           # for information, as part_name
///     part = 2                  # number of the part; palmar product parts lists them
///     part_name = "handle"
///     grip = "medium_wrap"
///     along = 0.45              # fraction of the part's length
///     edge = 0.0                # share of the fingers' breadth that is there, -0.5 to 0.5
///     toward = 1                # thumb's side: 1 where along grows, -1 where it starts
///     turn_deg = 90.0           # about the part's axis
///     over_end = false          # the palm lies over the end of the part
///     wrist = [0.0, -0.6, 0.8]  # of a precision grip: from the fingertips' middle to the wrist,
///                               # the product's frame; not needed
///     along_toward = [0, 0, 1]  # where along grows and
///     turn_from = [1, 0, 0]     # from where turn_deg is counted, the product's frame; not needed
///     [[fingertip]]             # of a precision grip, once per finger
///     finger = "thumb"
///     along = 0.5
///     turn_deg = 30.0
///     height_mm = 12.0          # distance from the part's centre line
struct HoldFile {
  grasp::Hold hold;
  std::string product;  ///< name of the product that it was found on; "": not said
};

/// Needed are part, grip and along, and of a fingertip all four. Throws InputError naming file,
/// line, key, value and what is allowed: for a file that can't be read or is no TOML, an unknown
/// key (with the nearest known one), a value out of range, a precision grip without fingertips or a
/// power grip with some, a finger given twice.
HoldFile read_hold(const std::string& path);

/// As such a file. Numbers read back exactly; angles within one unit of the last digit. Throws
/// OutputError.
void write_hold(const std::string& path, const HoldFile& file);
std::string hold_toml(const HoldFile& file);

}  // namespace palmar::records
