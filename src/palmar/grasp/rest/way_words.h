// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"

namespace palmar {

/// The main direction of a way in the hand frame, in words: "the fingertips", "the wrist".
std::string way_words(const Hand& hand, Vec3 way);

}  // namespace palmar
