// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "palmar/hand/anatomy.h"

namespace palmar::capture {

// What was drawn on a hand and isn't found in a scan, reported to its owner; "" if nothing lacks.

/// `missing`: creases by the segment distal of them, the wrist's by the palm.
std::string missing_creases_note(const std::vector<hand::Segment>& missing);

/// Dots to be drawn: three on each phalanx, eight on the back of the hand (segment palm).
std::map<hand::Segment, int> advised_dots();

/// `scan`: name for the message; segments with fewer dots `found` than `expected` are listed.
std::string missing_dots_note(const std::string& scan, const std::map<hand::Segment, int>& found,
                              const std::map<hand::Segment, int>& expected);

}  // namespace palmar::capture
