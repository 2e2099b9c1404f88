// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/grasp/grip.h"
#include "palmar/hand/anatomy.h"

namespace palmar::grasp {

/// What a grip isn't itself without: which fingers have to touch the product. By the definitions of
/// the GRASP taxonomy (Feix et al. 2016, table II, opposition types and virtual fingers): palm and
/// fingers oppose each other in wraps, the thumb, too, where they don't come round (large diameter,
/// sphere); in a hook the fingers pull against the palm or the
/// load, in pinches, rings and the tripod the thumb opposes one or two fingers that are named.
struct GripNeeds {
  std::vector<hand::Finger> fingers;  ///< each of them
  int least_fingers = 0;              ///< so many besides the thumb
};
GripNeeds needs_of(Grip grip);

/// What is lacking for a hand to hold in this grip, given the regions of its skin that touch; ""
/// if nothing is. "the thumb doesn't touch it", "only the ring finger touches it; a tripod needs
/// thumb, index finger and middle finger".
std::string lacking_contact(Grip grip, const std::vector<hand::Region>& touching);

}  // namespace palmar::grasp
