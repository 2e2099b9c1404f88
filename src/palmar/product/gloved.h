// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/product/product.h"

namespace palmar::product {

/// The product as it is for the bare skin inside a glove: grown by the glove's thickness. The glove
/// is taken to lie on the product's surface, so that what closes round it and what presses on it
/// work as with a bare hand; let ContactOptions::coatings have a cover of that thickness for its
/// softness, whose outside is this product's surface.
///
/// Signed distance: the product's less the thickness, d' = d - t. Outside and as deep inside as the
/// product is thick that is the exact distance to the offset surface, which rounds convex edges
/// with radius t. The nearest point lies t farther out along the normal. The mesh, for pictures and
/// maps, has its vertices moved out likewise; its triangles stay.
///
/// Throws UsageError unless 0 <= thickness <= 20 mm.
Product gloved(const Product& product, double thickness);

}  // namespace palmar::product
