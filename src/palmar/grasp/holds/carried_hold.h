// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/grasp/holds/hold.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::grasp {

/// The hold of one product on another that lies in the same frame, a redesign of it: the part there
/// whose centre line, as far as it goes, is nearest to the middle of the hand, at the same place,
/// with the palm and the thumb's side towards the same directions of the frame. The coordinates of
/// a hold are those of its part, and the parts of a redesign may begin at the other end or turn
/// from another side. Throws UsageError if the hold is of no part of `before` or `after` has none.
Hold carried_hold(const Hold& hold, const product::ProductParts& before,
                  const product::ProductParts& after);

}  // namespace palmar::grasp
