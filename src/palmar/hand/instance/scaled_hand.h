// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// The hand with every length times `factor`: skin, joints, limit postures of the thumb, bones,
/// bulges over bent joints, dimensions. Angles and tissue stay as they are: moduli, the depths at
/// which they are reached and the size of bulges belong to the skin, not to the hand's size. No
/// substitute for hands of people, whose proportions differ. Throws UsageError unless `factor` is
/// 0.2 to 5.
Hand scaled(const Hand& hand, double factor);

}  // namespace palmar::hand
