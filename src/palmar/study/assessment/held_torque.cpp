// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/held_torque.h"

#include <algorithm>
#include <limits>

#include "palmar/contact/friction/friction.h"

namespace palmar::study {

double held_torque(const contact::PreparedHand& prepared, const contact::ContactResult& contact,
                   const geometry::DistanceField& product, const TorqueAxis& about,
                   double coefficient) {
  constexpr double kUnit = 1000.0;  // N mm; factors of about one
  if (coefficient <= 0.0) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const double sense : {1.0, -1.0}) {
    contact::FrictionOptions friction;
    friction.coefficient = coefficient;
    friction.load.torque = sense * kUnit * about.axis.normalized();
    const contact::FrictionResult solved =
        contact::solve_friction(prepared, contact, product, about.at, friction);
    least = std::min(least, kUnit * solved.load_factor.value_or(0.0));
  }
  return least;
}

grasp::GraspIndex held_torque_index(double torque) {
  grasp::GraspIndex row;
  row.key = kHeldTorqueKey;
  row.name = "largest torque about the grip axis that friction holds";
  row.group = "stability";
  row.unit = "N mm";
  row.value = torque;
  row.lowest = 0.0;
  row.better = grasp::Better::kUp;
  row.definition =
      "limit load of Coulomb friction at the pressures found: the largest torque about the axis of "
      "the grip, in the weaker of both senses, that tangential forces within the friction of every "
      "place can bear";
  row.source = "docs/method/friction.md";
  return row;
}

}  // namespace palmar::study
