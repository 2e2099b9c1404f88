// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/friction_settings.h"

#include <fmt/format.h>

#include <string_view>

#include "palmar/core/error.h"
#include "palmar/product/mass.h"

namespace palmar::grasp {
namespace {

constexpr double kMostAcceleration = 100.0;  // standard gravities; a blow with a hammer

void require_positive(std::string_view field, const std::optional<double>& value,
                      std::string_view unit) {
  if (!value || (*value > 0.0 && *value <= 1e4)) return;
  throw UsageError(fmt::format("setting \"{}\" is {}; more than 0 and at most 10000 {} is required",
                               field, *value, unit));
}

}  // namespace

void FrictionSettings::check() const {
  if (friction && !(*friction >= 0.0 && *friction <= 5.0)) {
    throw UsageError(fmt::format("setting \"friction\" is {}; 0 to 5 is required", *friction));
  }
  require_positive("density", density, "g/cm3");
  require_positive("mass", mass, "kg");
  require_positive("weight", weight, "N");
  if (int(mass.has_value()) + int(weight.has_value()) + int(density.has_value()) > 1) {
    throw UsageError(
        "more than one of setting \"mass\", setting \"weight\" and setting \"density\" is given; "
        "one is allowed");
  }
  if (acceleration && !(*acceleration >= 0.0 && *acceleration <= kMostAcceleration)) {
    throw UsageError(
        fmt::format("setting \"acceleration\" is {}; 0 to {:g} standard gravities are allowed",
                    *acceleration, kMostAcceleration));
  }
  if (acceleration && !has_weight()) {
    throw UsageError(
        "setting \"acceleration\" needs what is accelerated: setting \"mass\", setting \"weight\" "
        "or setting \"density\"");
  }
  if (gravity && gravity->isZero(0.0)) {
    throw UsageError("setting \"gravity\" is 0,0,0; a direction is required");
  }
}

contact::FrictionOptions FrictionSettings::options() const {
  check();
  contact::FrictionOptions result;
  result.coefficient = friction.value_or(has_load() ? kUsualFriction : 0.0);
  contact::ProductLoad& load = result.load;
  if (mass) load.weight = product::kStandardGravity * *mass;
  if (weight) load.weight = *weight;
  load.weight *= 1.0 + acceleration.value_or(0.0);
  load.gravity = gravity;
  load.mass_centre = mass_centre;
  load.force = force.value_or(load.force);
  load.torque = torque.value_or(load.torque);
  load.force_at = force_at;
  result.check();
  return result;
}

contact::FrictionOptions FrictionSettings::options_for(const product::Product& product) const {
  contact::FrictionOptions result = options();
  if (density || (has_weight() && !mass_centre)) {
    const product::MassProperties solid = product::mass_properties(product);
    if (density) {
      result.load.weight =
          (1.0 + acceleration.value_or(0.0)) * product::weight_of(solid.volume, *density);
    }
  }
  return result;
}

}  // namespace palmar::grasp
