// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// Where a hand lies on a product. Product frame, mm.
struct LaidSite {
  Vec3 knuckle = Vec3::Zero();   ///< below the middle finger's knuckle, on the surface
  Vec3 up = Vec3::UnitZ();       ///< unit: out of the product, away from what it stands on
  Vec3 fingers = Vec3::UnitX();  ///< unit, across `up`: from the wrist to the fingertips
};

/// A hand that lies on a product from above, relaxed (kRestingHand: on a computer mouse, a palm
/// rest) or flat (kFlatHand): the palm below the knuckles comes down at `site.knuckle`, the five
/// pads on what is below them, or, where that is only what the product stands on (the plane across
/// `up` through its lowest point), on its nearest side. By inverse kinematics (FingertipIk) from
/// the named posture. Held: the palm and two fingers touch, or three fingers. Deterministic. Not
/// being able to is a status with a message.
Grasp close_laid_hand(const hand::Hand& hand, const product::Product& product, Grip grip,
                      const LaidSite& site);

/// The tip of the index finger presses a point of the product, the other fingers bent out of the
/// way; the hand comes from that one of eight sides from which it is least in the way of itself.
/// Held: the tip comes within 1 mm and no bone of the hand would be in the product.
Grasp close_finger_push(const hand::Hand& hand, const product::Product& product, const Vec3& point);

}  // namespace palmar::grasp
