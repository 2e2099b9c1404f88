// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/anatomy.h"
#include "palmar/hand/posture.h"

namespace palmar::cli {

// Parts of the hand as people call them; files keep the short names ("index_distal").

/// "thumb", "index finger".
std::string finger_words(hand::Finger finger);

/// "bending of the thumb's knuckle", "spreading of the index finger's knuckle".
std::string joint_words(hand::Dof dof);

/// Angles in degrees, a line for the wrist and for each finger, joints by their everyday names.
std::string posture_text(const hand::Posture& posture);

/// The text with names of regions and joint angles replaced: "in middle_distal" -> "in the tip of
/// the middle finger". Other words stay.
std::string with_plain_names(const std::string& text);

}  // namespace palmar::cli
