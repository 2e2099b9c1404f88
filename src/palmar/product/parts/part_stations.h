// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::product {

/// Which way along the part runs: from its free end, else towards the middle of the product, else
/// towards its thicker half. True if it has to be turned round.
bool runs_backwards(const ProductPart& part, const std::vector<Vec3>& line, const Vec3& middle);

/// What turn 0 of a part points to: the middle of its opening, else of the product, else where the
/// part is widest.
Vec3 zero_of(const ProductPart& part, const std::vector<Vec3>& line, const Vec3& middle);

/// Stations of a line with frames that turn as little as they can from the middle one on (Wang et
/// al. 2008, double reflection); `zero` is what turn 0 points to at the middle.
std::vector<PartStation> stations_of(const std::vector<Vec3>& line, bool is_ring, const Vec3& zero);

/// Where the girth of a body is least between larger ones, and its neck.
std::vector<PartWaist> waists_of(const std::vector<PartSection>& sections);

}  // namespace palmar::product
