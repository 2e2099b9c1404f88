// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/grasp/indices/wrench_space.h"

namespace palmar::grasp {

struct ReductionOptions {
  int per_region = 2;      ///< contacts at most per region of the hand, 1 to 16
  int max_contacts = 24;   ///< in all, 4 to 64; regions with the least force get fewer
  double friction = 0.46;  ///< mu of skin on the product
  /// Whether a contact may carry torsion, as far as its patch of skin allows.
  bool soft_finger = true;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Patches of loaded skin as a few contacts. The loaded vertices of a region are separated into
/// groups near to each other (k-means of their positions weighted by force, started at the vertex
/// of largest force and then always at the one farthest from those chosen, so it draws no random
/// numbers). A contact stands at its group's centre of pressure with the force-weighted mean of its
/// normals; its normal force is the length of the sum of the group's forces. Its torsion is the
/// moment about its normal at which the whole patch slides round its centre under the pressure it
/// has,
///
///     torsion = mu sum p_i r_i / sum p_i,   r_i the distance from the normal through the centre
///
/// (a disc of radius a under even pressure: 2/3 mu a). Groups without force are left out. In the
/// order of regions; product frame.
///
/// The normal of a vertex is the way on which it was moved onto the product; where that is shorter
/// than 0.05 mm, the deformed skin's own.
std::vector<GraspContact> reduce_contact(const hand::Hand& hand,
                                         const contact::ContactResult& contact,
                                         const ReductionOptions& options = {});

}  // namespace palmar::grasp
