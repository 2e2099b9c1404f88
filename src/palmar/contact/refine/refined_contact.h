// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/contact/contact.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// A contact on the hand's skin as it was refined. `hand` is the hand with that skin, in its
/// reference posture; its first vertices are those of the hand's own. Per-vertex fields of
/// `contact` follow it; it has no `refined` of its own.
struct RefinedContact {
  std::shared_ptr<const hand::Hand> hand;
  ContactResult contact;
};

/// Peaks on cells of 24 mm^2 that the last halving moved by less are resolved.
inline constexpr double kResolvedChange = 0.05;
/// Halvings at most: edges of 2.5 mm become 0.3 mm. Our choice.
inline constexpr int kMostLevels = 3;
/// Vertices that are added at most; what would take more stays as it is, unresolved. Our choice.
inline constexpr int kMostAdded = 4000;

}  // namespace palmar::contact
