// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/press/press.h"

namespace palmar::contact {

/// press() on a plane or ellipsoid at one depth [mm].
PressStep press_half_space(const PressOptions& options, double depth);

/// Where press() puts the indenter on a hand's region at first touch: z points out of the hand
/// along the press, x towards the fingertip; a sphere's lowest point, a plate's plane in the
/// origin.
geometry::Rigid3 indenter_at_first_touch(const PressOptions& options, const PreparedHand& hand);

/// press() on a hand's region at one depth [mm].
PressStep press_hand_region(const PressOptions& options, const PreparedHand& hand, double depth);

}  // namespace palmar::contact
