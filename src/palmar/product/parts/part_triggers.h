// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/product/parts/product_parts.h"

namespace palmar::product {

/// Triggers of bars that carry something at an end which reaches out to one side (a pistol). The
/// bar is looked at from that side, in its mid-plane and 4 mm beside it: a trigger is a stretch of
/// 10 to 70 mm, next to what the bar carries, that stands 4 to 45 mm before the bar, is no steeper
/// than 45 degrees and beyond which the product reaches at least 12 mm farther. The limits are our
/// choice: a finger is 16 mm thick (Greiner 1991), and index fingers reach no farther round a
/// handle.
std::vector<PartTrigger> triggers_of(const Product& product, const std::vector<ProductPart>& parts);

/// Buttons on the flat faces of a product, largest first: seen along each of the three directions
/// that its surface faces most sharply, what stands 1.5 to 15 mm out of the level that most of it
/// has (a third at least), is 6 to 32 mm wide and long and no higher than 0.6 of that, and lies
/// wholly on that level. The limits are our choice.
std::vector<PartButton> buttons_of(const geometry::TriangleMesh& mesh,
                                   const std::vector<int>& part_of_triangle);

}  // namespace palmar::product
