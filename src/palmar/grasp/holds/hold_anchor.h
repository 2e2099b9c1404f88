// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/grasp/hold_value.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::grasp {

/// From where a hold counts `along` and its turns on this product; nothing on a ring.
std::optional<HoldAnchor> anchor_of(const Hold& hold, const product::ProductParts& parts);

/// A hold of another version of a product, counted as this one counts. A part's centre line begins
/// at the one end or the other and turns begin somewhere, by the shape; both may change with it.
/// Where the part still lies along the hold's anchor (within 20 degrees) the hold means the same
/// place and directions as before. Where it doesn't the file was turned: the part's own
/// coordinates stay, and the wrist's side turns along with the part. A hold without an anchor, or
/// on a ring, stays as it is.
Hold as_anchored(const Hold& hold, const product::ProductParts& parts);

}  // namespace palmar::grasp
