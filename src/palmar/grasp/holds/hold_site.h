// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/grasp/holds/hold.h"
#include "palmar/grasp/power/grip_axis.h"

namespace palmar::grasp {

/// A power grip's hold seen by one hand.
struct HoldSite {
  GripSite site;               ///< `point`: in the middle of the four fingers
  Vec3 palm = Vec3::UnitZ();   ///< unit, across the axis: from the axis to the palm, product frame
  double turn = 0.0;           ///< HandlePose::turn of that
  bool is_loop = false;        ///< fingers go through an opening
  bool is_round_both = false;  ///< fingers go round both handles of a tool with two
};

/// Where a hand takes a hold. `hand` gives size and side. The site's measures are means over what
/// the four fingers cover. Throws UsageError if the product has no such part.
HoldSite site_of(const Hold& hold, const product::ProductParts& parts,
                 const product::Product& product, const hand::Hand& hand);

/// The part with that number. Throws UsageError that lists the parts.
const product::ProductPart& part_of(const Hold& hold, const product::ProductParts& parts);

/// What fingers close on: the product, of a loop the loop alone, so that fingers that reach through
/// its opening don't stop at what is behind it.
std::shared_ptr<const geometry::DistanceField> grasped_surface(const Hold& hold,
                                                               const product::ProductParts& parts,
                                                               const product::Product& product);

/// Breadth of the four fingers side by side, mm. Metacarpal breadth is measured across the heads,
/// which is where they lie in a fist.
double fingers_breadth(const hand::Hand& hand);

}  // namespace palmar::grasp
