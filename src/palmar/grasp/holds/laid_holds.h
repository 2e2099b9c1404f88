// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/holds/hold_terms.h"
#include "palmar/grasp/precision/laid_hand.h"

namespace palmar::grasp {

/// Where a hand that takes such a hold (is_laid()) lies: `along` is where the middle finger's
/// knuckle is, `turn` on which side of the part the hand lies, and its fingers point to growing
/// `along`
/// (`toward` 1) or to where it starts (-1). Over an end of the part they point to `turn`.
LaidSite laid_site_of(const Hold& hold, const product::ProductParts& parts,
                      const product::Product& product);

/// Holds by a hand that rests on the product or pushes it: those that the shape suggests, or the
/// one that is asked for. Scores aren't summed up yet.
std::vector<RankedHold> laid_holds(const HoldScene& scene, const HoldOptions& options,
                                   const Progress& progress);

}  // namespace palmar::grasp
