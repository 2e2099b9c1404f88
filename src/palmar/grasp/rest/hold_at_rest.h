// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// How one hand takes hold of a product with the whole hand, and how that comes to rest. Hands of
/// other size and form come to rest from there, so that they differ in what they are and not in how
/// they hold: closing the hand has steps in its size.
struct HoldAtRest {
  GripState closed, rest;
  GripState on_coarse_skin;  ///< at rest there (PreparedHand::coarse())
  Vec3 palm = Vec3::Zero();  ///< where the palm lies on the product, hand frame, mm
  double hand_length = 0.0;  ///< mm

  /// A state as a hand of another length has it: the same angles, and the product lies where it lay
  /// on the palm, lengths in hand lengths.
  GripState scaled(const GripState& state, double length) const;
};

/// Null where the grasp is no wrap by the whole hand, isn't held or doesn't come to rest. Throws
/// Cancelled.
std::shared_ptr<const HoldAtRest> hold_at_rest(const contact::PreparedHand& hand,
                                               const product::Product& product, const Grasp& grasp,
                                               const BalanceOptions& options,
                                               const contact::ContactOptions& contact = {},
                                               const Progress& progress = {});

/// Whether all of the hand lies on what it holds: a power grip that is no hook.
bool is_by_whole_hand(Grip grip);

}  // namespace palmar::grasp
