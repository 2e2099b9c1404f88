// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// Brings a hand that rests on a product or pushes it (is_non_prehensile()) to the force asked for:
/// with its joints as they are, it is moved along one direction until the skin's forces on the
/// product add up to that force along it, to 0.5 %. The direction is that in which the palm faces;
/// of a push, straight into the surface. Nothing is asked of the rest of the forces: what the
/// product stands on carries them. kSupported where the force is reached; else kNotConverged, with
/// the force that is reached, or kNoContact. `grasp` gets the new placement.
Balance press_down(const contact::PreparedHand& hand, const product::Product& product, Grasp& grasp,
                   const BalanceOptions& options, const contact::ContactOptions& contact,
                   const Progress& progress);

}  // namespace palmar::grasp
