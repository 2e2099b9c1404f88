// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/press.h"

namespace palmar {

/// press() on a plane or ellipsoid at one depth [mm].
PressStep press_half_space(const PressOptions& options, double depth);

/// press() on a hand's region at one depth [mm].
PressStep press_hand_region(const PressOptions& options, const PreparedHand& hand, double depth);

}  // namespace palmar
