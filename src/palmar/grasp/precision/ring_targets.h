// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::grasp {

/// The two rings of scissors, product frame, mm.
struct ScissorRings {
  product::PartOpening thumb;    ///< the smaller one
  product::PartOpening fingers;  ///< the larger one
  int thumb_part = 1;            ///< number of the part that goes round the thumb's
  Vec3 toward =
      Vec3::UnitX();  ///< unit, in their plane: to the blades, across the line between them
};

/// Two openings of about one plane (axes within 30 degrees, the middle of one at most a finger off
/// the plane of the other) that lie side by side: closer to each other than 1.6 times their mean
/// size, both with room for a finger and neither for a hand (discs of 12 to 45 mm). The limits are
/// our choice. Nothing if there are none; of several pairs the nearest.
std::optional<ScissorRings> scissor_rings(const product::ProductParts& parts,
                                          const product::Product& product);

/// Where thumb and fingers press when they shut scissors: each on that wall of its ring which is
/// next to the other ring. The thumb in the middle of its ring, as many of middle and ring finger
/// in theirs as find room, and the index finger before it on the outside of the shank, if there is
/// something to lie on. Empty if a ray meets no wall.
std::vector<FingertipTarget> ring_targets(const hand::Hand& hand, const product::Product& product,
                                          const ScissorRings& rings);

}  // namespace palmar::grasp
