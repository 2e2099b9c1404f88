// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/find_grasp.h"

namespace palmar {

void GraspOptions::check() const {
  if (!grip || is_power(*grip)) {
    power.check();
    return;
  }
  PrecisionGripOptions asked = precision;
  asked.grip = *grip;
  asked.check();
}

Grasp find_grasp(const Hand& hand, const Product& product, const GraspOptions& options,
                 const Progress& progress) {
  if (!options.grip || is_power(*options.grip)) {
    PowerGraspOptions power = options.power;
    power.grip = options.grip;
    return close_power_grasp(hand, product, power, progress);
  }
  PrecisionGripOptions precision = options.precision;
  precision.grip = *options.grip;
  return close_precision_grip(hand, product, precision, progress);
}

}  // namespace palmar
