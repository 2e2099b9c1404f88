// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"

namespace palmar::report {

/// Writes a posed hand by the ending of `path`: .glb (skin coloured by region, and bones), .ply,
/// .obj, .stl (skin), .png (a picture from the palmar and the radial side). Throws UsageError on
/// another ending, OutputError.
void export_posed_hand(const std::string& path, const hand::Hand& hand,
                       const hand::Posture& posture);

}  // namespace palmar::report
