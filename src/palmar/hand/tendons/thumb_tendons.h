// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/tendons/digit_tendons.h"

namespace palmar::hand {

/// Thumb part of route_tendons(): points of Mirakhorlo et al. 2016, tables 4, 6 and 7.
DigitTendons route_thumb_tendons(const Hand& hand);

}  // namespace palmar::hand
