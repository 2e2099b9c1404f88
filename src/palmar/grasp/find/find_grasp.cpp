// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/find/find_grasp.h"

#include <cmath>
#include <string>

#include "palmar/core/error.h"
#include "palmar/grasp/find/grasp_place.h"

namespace palmar::grasp {

bool GraspOptions::is_placed() const {
  const auto says = [](const PlacementRequest& placement) {
    return placement.at || placement.axis || placement.turn || placement.region ||
           placement.product_from_hand;
  };
  if (grip && !is_power(*grip)) return says(precision.placement) || !precision.targets.empty();
  return says(power.placement);
}

bool GraspOptions::leaves_hold_open() const { return !hold && !hold_rank && !is_placed(); }

void GraspOptions::check() const {
  if (grip_force && !(*grip_force > 0.0 && std::isfinite(*grip_force))) {
    throw UsageError("setting \"grip force\" is " + std::to_string(*grip_force) +
                     " N; more than 0 N is required");
  }
  if (hold_rank && *hold_rank < 1) {
    throw UsageError("setting \"hold\" is " + std::to_string(*hold_rank) +
                     "; the best is 1, the next 2, ...");
  }
  if (hold && is_placed()) {
    throw UsageError("a hold and coordinates both say where the hand goes; one of them is allowed");
  }
  holds.check();
  if (!grip || is_power(*grip)) {
    power.check();
    return;
  }
  PrecisionGripOptions asked = precision;
  asked.grip = *grip;
  asked.check();
}

Grasp find_grasp(const hand::Hand& hand, const product::Product& product,
                 const GraspOptions& options, const Progress& progress) {
  return GraspPlace(hand, product, options, progress).reference_grasp();
}

Grasp close_power_grasp(const hand::Hand& hand, const product::Product& product,
                        const PowerGraspOptions& options, const Progress& progress) {
  options.check();
  GraspOptions asked;
  asked.grip = options.grip;
  asked.power = options;
  asked.holds.is_power_only = true;
  return find_grasp(hand, product, asked, progress);
}

}  // namespace palmar::grasp
