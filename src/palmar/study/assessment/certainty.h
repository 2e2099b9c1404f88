// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/contact.h"
#include "palmar/grasp/equilibrium/nearby_rests.h"
#include "palmar/product/product.h"

namespace palmar::study {

/// How the figures of a contact change, each over what it was, less 1.
struct FigureChange {
  double force = 0.0;  ///< sum of normal forces
  double area = 0.0;
  double peak_pressure_cells = 0.0;
  double mean_pressure = 0.0;
};

/// Another state in which the hand may rest as well.
struct SecondRest {
  FigureChange change;  ///< there, against the first
  double effort = 1.0;  ///< effort and departure from the hold there, over those of the first
};

/// How sure the figures of a hold are, of its own making: by how much they change if hand or force
/// change by 1 %, and whether there is a second rest.
struct Certainty {
  FigureChange hand_size;   ///< in a hand that is 1 % larger
  FigureChange grip_force;  ///< at 1 % more force
  std::optional<SecondRest> second;

  /// Change of the peak on cells that a hand and a force known to 1 % leave open, share.
  double peak_unsure() const;
};

/// One contact is solved for each state, on the hand's own skin. `rest`: the first.
Certainty certainty_of(const contact::PreparedHand& hand, const product::Product& product,
                       const grasp::GripState& rest, const grasp::NearbyRests& nearby,
                       const contact::ContactOptions& options);

}  // namespace palmar::study
