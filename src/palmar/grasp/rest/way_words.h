// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// The main direction of a way in the hand frame, in words: "the fingertips", "the wrist".
std::string way_words(const hand::Hand& hand, Vec3 way);

}  // namespace palmar::grasp
