// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/certainty.h"

#include <cmath>

#include "palmar/hand/skin/skinning.h"

namespace palmar::study {
namespace {

double change(double now, double before) { return before > 0.0 ? now / before - 1.0 : 0.0; }

}  // namespace

double Certainty::peak_unsure() const {
  return std::hypot(hand_size.peak_pressure_cells, grip_force.peak_pressure_cells);
}

Certainty certainty_of(const contact::PreparedHand& hand, const product::Product& product,
                       const grasp::GripState& rest, const grasp::NearbyRests& nearby,
                       const contact::ContactOptions& options) {
  contact::ContactOptions plain = options;
  plain.error_band = false;
  plain.refine = false;
  const auto figures = [&](const grasp::GripState& state, const geometry::DistanceField& field) {
    return contact::solve_hand_contact(hand, hand::pose_skin(hand.hand(), state.posture),
                                       state.product_from_hand, field, plain)
        .total;
  };
  const contact::RegionContact first = figures(rest, *product.distance);
  // `size`: of the hand, over its own.
  const auto changed = [&](const grasp::GripState& state, const geometry::DistanceField& field,
                           double size) {
    const contact::RegionContact now = figures(state, field);
    return FigureChange{
        .force = change(size * size * now.force, first.force),
        .area = change(size * size * now.area, first.area),
        .peak_pressure_cells = change(now.peak_pressure_cells, first.peak_pressure_cells),
        .mean_pressure = change(now.mean_pressure, first.mean_pressure)};
  };
  Certainty result;
  result.hand_size = changed(nearby.in_larger_hand, *nearby.shrunk, 1.0 + grasp::kNearbyChange);
  result.grip_force = changed(nearby.firmer, *product.distance, 1.0);
  if (nearby.other) {
    result.second = SecondRest{.change = changed(nearby.other->state, *product.distance, 1.0),
                               .effort = nearby.other->merit};
  }
  return result;
}

}  // namespace palmar::study
