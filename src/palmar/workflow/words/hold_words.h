// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/grasp/find/grasp_settings.h"

namespace palmar::workflow {

/// By which part of the product and how it is held, in words; "" and unset: not said.
struct HoldWords {
  std::string hold;             ///< a hold's file (.toml), or its number in the ranked list
  std::string part;             ///< name or number of a part of the product
  std::optional<double> along;  ///< where along the part, 0 to 1
  std::string toward;  ///< where the thumb's side points: "up", "down", an axis ("+x") or "x,y,z"
  std::string up;      ///< the product's up in use: an axis or "x,y,z"; +z for `toward` "up"
  std::string purpose = "use";  ///< or "hand-over"
  std::string weights;  ///< file of records::hold_weights_toml() for hand-over; "": built in
};

/// The file of a hold is read. Throws UsageError, InputError naming the file.
grasp::HoldRequest hold_request(const HoldWords& words);

/// "any" (as people would choose) and "power" have no grip; else the grip of that name. Throws
/// UsageError with the nearest grip and those that are allowed.
std::optional<grasp::Grip> parse_grip(const std::string& text);
/// "any, power, medium_wrap, ...".
std::string grip_list();

}  // namespace palmar::workflow
