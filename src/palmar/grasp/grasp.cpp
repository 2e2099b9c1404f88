// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grasp.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"

namespace palmar::grasp {

void PowerGraspOptions::check() const {
  const auto depth = [](const char* name, double value, double most) {
    if (!(value > 0.0) || value > most) {
      throw UsageError(std::string(name) + fmt::format(" is {:g} mm; ", value) +
                       fmt::format("above 0 and at most {:g} mm is allowed", most));
    }
  };
  depth("palm limit depth", palm_limit_depth, 15.0);
  depth("finger limit depth", finger_limit_depth, 10.0);
  if (placement.at && !placement.at->allFinite()) {
    throw UsageError("placement: at is not a finite point; three lengths in mm are required");
  }
  if (placement.axis && !(placement.axis->allFinite() && placement.axis->norm() > 1e-9)) {
    throw UsageError("placement: axis has no direction; three numbers, not all 0, are required");
  }
  if (grip && !is_power(*grip)) {
    throw UsageError("grip: " + std::string(name_of(*grip)) +
                     " is no power grip; medium_wrap, large_diameter, small_diameter, "
                     "power_sphere or fixed_hook is allowed");
  }
  if (candidates < 1) {
    throw UsageError("candidates: " + std::to_string(candidates) + "; at least 1 is required");
  }
  if (placement.region) {
    const Vec3 size = placement.region->sizes();
    if (!size.allFinite() || !(size.minCoeff() > 0.0)) {
      throw UsageError(
          "placement: the region has no inside; its corners have to differ in x, y and z");
    }
  }
  if (placement.product_from_hand &&
      (placement.at || placement.axis || placement.turn || placement.region)) {
    throw UsageError(
        "placement: a full placement leaves nothing to choose; at, axis, turn or region can't be "
        "given with it");
  }
  if (placement.turn && !std::isfinite(*placement.turn)) {
    throw UsageError("placement: turn is not a number; an angle is required");
  }
}

std::string name_of(StopReason reason) {
  switch (reason) {
    case StopReason::kLimitDepth:
      return "limit_depth";
    case StopReason::kRangeOfMotion:
      return "range_of_motion";
    case StopReason::kProximalStop:
      return "proximal_stop";
    case StopReason::kDistalStop:
      return "distal_stop";
    case StopReason::kOtherFinger:
      return "other_finger";
    case StopReason::kNotReached:
      return "not_reached";
    case StopReason::kGiven:
      return "given";
  }
  return "unknown";
}

std::string name_of(GraspStatus status) {
  switch (status) {
    case GraspStatus::kHeld:
      return "held";
    case GraspStatus::kPartlyHeld:
      return "partly_held";
    case GraspStatus::kTooLarge:
      return "too_large";
    case GraspStatus::kTooSmall:
      return "too_small";
    case GraspStatus::kNotGraspable:
      return "not_graspable";
  }
  return "unknown";
}

}  // namespace palmar::grasp
