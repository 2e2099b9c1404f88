// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/contact/contact.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar {

/// How far the product's surface may turn over one edge of the skin's mesh, rad: an edge or fillet
/// of the product is resolved if its radius is at least twice the skin's edge. Measured on a ball
/// of skin that presses an edge of 90 degrees (resolution_test.cpp): below it the peak on cells
/// moves by at most 5 % when the mesh is halved, above it by 4 to 40 %. Force and area are within 5
/// and 30 % all the same.
inline constexpr double kResolvedTurn = 0.5;

/// Share of a force beyond which it is said that it isn't resolved. Our choice.
inline constexpr double kToldShare = 0.05;

/// Whether the product turns too far between a vertex and one of its neighbours near the product.
bool is_unresolved(const SkinGeometry& skin, const SkinOnProduct& on_product, int vertex);

/// That pressures aren't resolved and where: "31 % of the force is on edges of the product that are
/// sharper than the skin's mesh (thenar 52 %, index_distal 12 %); force and area hold, pressures
/// there don't". Empty if no region has more than kToldShare of its force there.
std::string unresolved_words(const ContactResult& contact);

}  // namespace palmar
