// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/product/product.h"

namespace palmar::product {

/// Of a product that is solid throughout.
struct MassProperties {
  double volume = 0.0;         ///< mm^3
  Vec3 centre = Vec3::Zero();  ///< of the volume, product frame, mm
};

/// Throws InputError if the surface encloses no volume to speak of: it is open, or a sheet. The
/// message names the product, the length of its open edges and what to give instead. Cracks whose
/// rim is shorter than 5 % of the square root of the area don't count.
MassProperties mass_properties(const Product& product);

inline constexpr double kStandardGravity = 9.80665;  ///< m/s^2; CGPM 1901

/// Weight [N] of a volume [mm^3] at a density [g/cm^3], standard gravity.
double weight_of(double volume, double density);

}  // namespace palmar::product
