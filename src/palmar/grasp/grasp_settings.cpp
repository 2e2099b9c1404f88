// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grasp_settings.h"

#include <string>

#include "palmar/core/error.h"

namespace palmar {
namespace {

GraspOptions options_of(const GraspSettings& settings) {
  GraspOptions result;
  result.grip = settings.grip;
  result.power.palm_limit_depth = settings.palm_limit_depth;
  result.power.finger_limit_depth = settings.finger_limit_depth;
  result.power.placement = settings.placement;
  result.precision.placement = settings.placement;
  result.precision.fingertip_depth = settings.fingertip_depth;
  result.precision.targets = settings.fingertips;
  return result;
}

}  // namespace

void GraspSettings::check() const {
  const std::string name = grip ? std::string(name_of(*grip)) : "power";
  if (!fingertips.empty() && (!grip || is_power(*grip))) {
    throw UsageError("setting \"fingertips\": grip " + name +
                     " holds with the whole hand; a precision grip is required, such as setting "
                     "\"grip\" tripod");
  }
  if (placement.region && grip && !is_power(*grip)) {
    throw UsageError("setting \"region\": grip " + name +
                     " takes fingertips to points; setting \"at\" or setting \"fingertips\" says "
                     "where");
  }
  options_of(*this).check();
}

GraspOptions GraspSettings::options() const {
  check();
  return options_of(*this);
}

}  // namespace palmar
