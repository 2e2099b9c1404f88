// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/grasp/rest/balance.h"

namespace palmar::grasp {

/// What a grasp lacks to be one, in words: that it isn't closed as its grip wants, doesn't come to
/// rest, or lacks there a finger that its grip needs (lacking_contact()). "" if nothing. Brings it
/// to rest. Throws Cancelled.
std::string flaw_at_rest(const contact::PreparedHand& hand, const product::Product& product,
                         const Grasp& grasp, const BalanceOptions& balance,
                         const contact::ContactOptions& contact = {},
                         const Progress& progress = {});

/// Where a place's hold has a flaw, the next way to take the product that has none, with both for
/// its RankedHolds::why_taken: of the place's holds those that people take at least a fifth as
/// often, the best four; and if there is no such one, and nothing on the product says where the
/// hand goes, however people take such a thing to hand it over. Nothing if none is better. `hand`:
/// the place's own; `options`: with which it was found. Throws Cancelled.
std::optional<GraspPlace> other_place_at_rest(
    const contact::PreparedHand& hand, const product::Product& product, const GraspPlace& place,
    const std::string& flaw, const GraspOptions& options, const BalanceOptions& balance,
    const contact::ContactOptions& contact = {}, const Progress& progress = {});

/// The grip in which people would hold a product that the grip asked for doesn't: whichever suits
/// it, wherever that is, and comes to rest in the same task; nothing if none does. Throws
/// UsageError, Cancelled.
std::optional<Grip> other_grip_that_holds(const contact::PreparedHand& hand,
                                          const product::Product& product,
                                          const GraspOptions& asked,
                                          const BalanceOptions& balance = {},
                                          const contact::ContactOptions& contact = {},
                                          const Progress& progress = {});

}  // namespace palmar::grasp
