// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// As solve_hand_contact(), but only the skin of one region (if given) can touch the product; the
/// rest of the hand is let through. For the indentation test of one region.
ContactResult solve_region_contact(const PreparedHand& prepared,
                                   const std::vector<Vec3>& posed_skin,
                                   const geometry::Rigid3& product_from_hand,
                                   const geometry::DistanceField& product,
                                   const ContactOptions& options, std::optional<hand::Region> only);

}  // namespace palmar::contact
