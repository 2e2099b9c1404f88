// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// The posture with the thumb as it comes to lie when it goes from out at the side and in front of
/// the palm to flexed across it, all its angles in proportion, until its phalanges meet the product
/// or a finger. One way, so that a thing or a hand a little larger has a thumb a little less bent;
/// least effort finds where it presses best from there. The way's ends are our choice.
hand::Posture with_opposed_thumb(const hand::Hand& hand, const product::Product& product,
                                 const GripState& closed);

}  // namespace palmar::grasp
