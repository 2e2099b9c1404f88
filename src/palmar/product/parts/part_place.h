// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/rigid3.h"
#include "palmar/product/parts/product_parts.h"

namespace palmar::product {

/// A place in a part's own coordinates: the same on a product that was moved or meshed anew.
struct PartPlace {
  double along = 0.0;   ///< fraction of the part's length, 0 to 1; beyond it on the lengthened ends
  double turn = 0.0;    ///< about the axis from `zero`, right-handed, rad, (-pi, pi]
  double height = 0.0;  ///< distance from the centre line, mm
};

/// The frame at a place on the centre line, product_from_place: x along the axis, z outwards at
/// `turn`, y = z x x. A ring's `along` is taken round it, others are lengthened straight on.
geometry::Rigid3 part_frame(const ProductPart& part, double along, double turn);

/// A place in the product's frame, mm.
Vec3 point_at(const ProductPart& part, const PartPlace& place);

/// The place of a point of the product's frame, by the nearest point of the centre line.
PartPlace place_of(const ProductPart& part, const Vec3& point);

}  // namespace palmar::product
