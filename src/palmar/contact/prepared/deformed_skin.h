// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

/// What other skin of the same hand does to the skin, mm; empty for nothing.
struct SkinMotion {
  std::vector<Vec3> besides;  ///< per vertex, on top of what the product does
  std::vector<int> vertex;    ///< that touches other skin
  std::vector<Vec3> whole;    ///< how far each of those goes in all, product and skin together
};

/// Sets result.deformed, the final result.displacement and the residual penetrations, from
/// result.force and the displacement of the skin so far [mm].
///
/// Loaded vertices go to the product's nearest point. The others move by their displacement along a
/// direction that is the product's normal where the skin penetrates, the skin's own (inward)
/// normal far away, and smoothly between the two in between: there the flank of a finger follows
/// the pad that is pushed in, instead of collapsing into the finger. The displacement vectors of
/// unloaded skin are then relaxed with their neighbours' (the corner lattice of the contact's edge
/// would else show as teeth), and skin that is still inside the product is put on its surface.
/// Afterwards the displacement is the part of each vertex' motion along its direction.
/// `is_active` says which vertices may move.
void deform_skin(const SkinGeometry& geometry, const SkinOnProduct& skin,
                 const geometry::DistanceField& product, const std::vector<char>& is_active,
                 const SkinMotion& by_skin, ContactResult& result);

}  // namespace palmar::contact
