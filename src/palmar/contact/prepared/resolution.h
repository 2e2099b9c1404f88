// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/contact.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

/// How far the product's surface may turn from a vertex of the pressed skin to its neighbour, rad:
/// an edge or fillet is resolved if its radius is at least twice the edge of the skin's mesh and
/// skin is not deeper in it than that. On a ball of skin on an edge of 90 degrees
/// (resolution_test.cpp) the peak on cells then moves by at most 5 % when the mesh is halved, else
/// by 4 to 40 %.
inline constexpr double kResolvedTurn = 0.5;

/// Share of a region's force from which on it is told. Our choice: at 5 % almost every region on a
/// bar with fillets of 3 mm was named.
inline constexpr double kToldShare = 0.3;

/// Whether the product turns too far between a vertex and one of its neighbours near the product.
bool is_unresolved(const SkinGeometry& skin, const SkinOnProduct& on_product, int vertex);

/// Whether a contact's pressures are resolved: those of a refined skin if its last halving moved
/// them little (refine/refine_contact.h), else if no region has more than kToldShare of its force
/// on edges that are sharper than the mesh.
bool is_resolved(const ContactResult& contact);

/// What the refinement did: "512 vertices were added to the skin on edges of the product, down to
/// edges of 0.3 mm; the last halving moved the highest pressures on cells by 2 %". Empty if nothing
/// was refined.
std::string refinement_words(const ContactResult& contact);

/// That pressures aren't resolved and where, the most pressed regions first: "56 % of the force is
/// on edges of the product that are sharper than the skin's mesh (index_distal 92 %, thenar 66 %
/// and 3 other regions); the highest pressures there may be off by 40 %, the hand's force and area
/// hold". Of a skin that was refined in vain: that it was. Empty if is_resolved().
std::string unresolved_words(const ContactResult& contact);

}  // namespace palmar::contact
