// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "palmar/hand/hand.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::hand {

/// Creases of a person where they were seen: proximal ones of phalanges, of the palm the wrist's;
/// hand frame, reference posture. Those that lack are where the joints suggest them.
using DrawnCreases = std::map<Segment, CreasePlane>;

/// Creases of a hand, with those that were seen where they were seen.
HandCreases creases_of(const geometry::TriangleMesh& skin, const Skeleton& skeleton,
                       const DrawnCreases& seen);

/// Those of the other hand: x turned over.
DrawnCreases mirrored(DrawnCreases creases);

}  // namespace palmar::hand
