// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/prepared/skin_displacement.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

/// Deepest penetration [mm] of each region's skin in the problem, and its shear modulus there
/// [MPa].
struct DeepestOfRegion {
  std::array<double, hand::kRegionCount> depth{}, shear_modulus{};
};
DeepestOfRegion deepest_of(const SkinOnProduct& skin, const SkinLoad& load,
                           const std::vector<hand::Region>& region);

/// Sets result.pressure, result.regions and result.total from the forces and the skin as it is
/// `pressed` (pressed_skin.h). `gap` [mm], of the skin without its bulge, and `shear_modulus` [MPa]
/// stand per vertex, `d_max` [mm] and `modulus` [MPa] per region. Solved as printed
/// (BulgeLaw::kPrinted), the area is that of the posed triangles in contact, the pressure stays,
/// and `gap` and `shear_modulus` are not looked at.
void add_totals(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                const SkinGeometry& pressed, const std::vector<double>& gap,
                const std::vector<double>& shear_modulus,
                const std::array<double, hand::kRegionCount>& d_max,
                const std::array<double, hand::kRegionCount>& modulus, double cell_area,
                ContactResult& result);

}  // namespace palmar::contact
