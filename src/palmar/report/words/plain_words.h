// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/contact.h"
#include "palmar/grasp/grasp.h"
#include "palmar/hand/hand.h"

namespace palmar::report {

/// "index finger, tip", "ball of the thumb (thenar)": a region or segment as a designer calls it.
std::string plain_words(hand::Region region);
std::string plain_words(hand::Segment segment);

/// Why a segment stopped, as a clause: "pressed in to the limit depth".
std::string plain_words(grasp::StopReason reason);

/// "Held", "Partly held", "Too large for this hand", ...
std::string plain_words(grasp::GraspStatus status);

/// "index PIP flexion"
std::string plain_words(hand::Dof dof);

/// The text with a capital at the beginning.
std::string capitalised(std::string text);

/// The double printed shortest so that it reads back exactly, as in assessment.json.
std::string exact_number(double value);

/// A double with so many significant digits, no exponent: 0.18234 with 3 -> "0.182", 1234.5 ->
/// "1230" never: digits before the point are kept, so "1235".
std::string short_number(double value, int significant = 3);

}  // namespace palmar::report
