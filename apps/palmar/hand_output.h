// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palmar::cli {

/// Throws UsageError naming --out unless the path ends in .hand.glb.
void check_hand_output(const std::string& out);
/// "folder/anna.hand.glb" -> "anna".
std::string hand_name_of(const std::string& out);
/// "folder/anna.hand.glb", ".mri" -> "folder/anna.mri".
std::string beside_hand(const std::string& out, const std::string& ending);

}  // namespace palmar::cli
