// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"
#include "palmar/contact/refine/skin_division.h"

namespace palmar::contact {

/// A prepared hand with its skin divided: of new vertices regions and segments are those of an end,
/// shares of blocks and moduli the means of both; compliance as in divided_compliance.h. Without
/// tissue on bone it is prepared from nothing. `wanted` (per vertex of the divided skin): the
/// vertices that forces on new ones may move. `with_meetings`: for skin on skin.
PreparedHand divided_hand(const PreparedHand& hand, const SkinDivision& division,
                          const std::vector<char>& wanted, bool with_meetings);

}  // namespace palmar::contact
