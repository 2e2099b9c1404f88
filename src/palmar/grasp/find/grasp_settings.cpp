// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/find/grasp_settings.h"

#include <fmt/format.h>

#include <string>

#include "palmar/core/error.h"

namespace palmar::grasp {
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
  result.holds.grip = settings.grip;
  result.holds.is_power_only = settings.is_power_only;
  settings.holding.apply_to(result);
  result.holds.palm_limit_depth = settings.palm_limit_depth;
  result.holds.finger_limit_depth = settings.finger_limit_depth;
  return result;
}

/// What says by coordinates where or how to hold: the setting's name; "" if nothing does.
std::string coordinates_of(const GraspSettings& settings) {
  const PlacementRequest& placement = settings.placement;
  if (placement.at) return "at";
  if (placement.axis) return "axis";
  if (placement.turn) return "turn";
  if (placement.region) return "region";
  if (placement.product_from_hand) return "product from hand";
  return settings.fingertips.empty() ? "" : "fingertips";
}

/// What says in the part's own terms where or how to hold.
std::string part_terms_of(const GraspSettings& settings) {
  if (settings.holding.part || !settings.holding.part_name.empty()) return "part";
  if (settings.holding.along) return "along";
  return settings.holding.toward ? "toward" : "";
}

void check_one_way(const GraspSettings& settings) {
  const std::string coordinates = coordinates_of(settings);
  const std::string terms = part_terms_of(settings);
  if (settings.holding.hold && settings.holding.number) {
    throw UsageError(
        "setting \"hold\" is given as a hold and as a number; one of them is required");
  }
  const bool is_chosen = settings.holding.hold || settings.holding.number;
  if (is_chosen && !coordinates.empty()) {
    throw UsageError("setting \"hold\" and setting \"" + coordinates +
                     "\" are both given; the hold says where and how, so coordinates can't be "
                     "given beside it");
  }
  if (settings.holding.hold && !terms.empty()) {
    throw UsageError("setting \"hold\" and setting \"" + terms +
                     "\" are both given; the hold itself says which part, where and how");
  }
  if (settings.holding.hold && settings.grip && *settings.grip != settings.holding.hold->grip) {
    throw UsageError("setting \"grip\" is " + std::string(name_of(*settings.grip)) +
                     ", but the hold is a " + std::string(name_of(settings.holding.hold->grip)) +
                     "; leave out setting \"grip\", or choose another hold");
  }
  if (settings.holding.hold && settings.is_power_only && !is_power(settings.holding.hold->grip)) {
    throw UsageError("setting \"grip\" is power, but the hold is a " +
                     std::string(name_of(settings.holding.hold->grip)) +
                     "; leave out setting \"grip\", or choose another hold");
  }
  if (!terms.empty() && !coordinates.empty()) {
    throw UsageError("setting \"" + terms + "\" and setting \"" + coordinates +
                     "\" are both given; either the part or coordinates say where to hold");
  }
  if (settings.holding.part && !settings.holding.part_name.empty()) {
    throw UsageError("setting \"part\" is given as a number and as a name; one is required");
  }
  if (settings.is_place_per_hand && is_chosen) {
    throw UsageError(
        "setting \"hold\" is given and setting \"place per hand\", too; a hold is the same for "
        "every hand");
  }
}

void check_direction(const std::optional<Vec3>& direction, const std::string& name) {
  if (!direction || (direction->allFinite() && direction->norm() > 0.0)) return;
  throw UsageError("setting \"" + name + "\" has no direction; a vector longer than 0 is required");
}

void check_numbers(const GraspSettings& settings) {
  if (settings.holding.number && *settings.holding.number < 1) {
    throw UsageError(fmt::format("setting \"hold\" is {}; 1 (the best) or more is required",
                                 *settings.holding.number));
  }
  if (settings.holding.part && *settings.holding.part < 1) {
    throw UsageError(
        fmt::format("setting \"part\" is {}; a number from 1 or a name is required (palmar product "
                    "parts lists them)",
                    *settings.holding.part));
  }
  if (settings.holding.along &&
      !(*settings.holding.along >= 0.0 && *settings.holding.along <= 1.0)) {
    throw UsageError(
        fmt::format("setting \"along\" is {}; a fraction of the part's length, 0 to 1, is required",
                    *settings.holding.along));
  }
  check_direction(settings.holding.toward, "toward");
  check_direction(settings.holding.up, "up");
}

}  // namespace

bool HoldRequest::is_empty() const {
  return !hold && !number && !part && part_name.empty() && !along && !toward && !up &&
         purpose == HoldPurpose::kUse;
}

void HoldRequest::apply_to(GraspOptions& options) const {
  options.hold = hold;
  options.hold_rank = number;
  options.holds.part = part;
  options.holds.part_name = part_name;
  options.holds.along = along;
  options.holds.toward = toward;
  options.holds.up = up;
  options.holds.purpose = purpose;
  options.holds.weights = weights;
}

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
  check_one_way(*this);
  check_numbers(*this);
  options_of(*this).check();
}

GraspOptions GraspSettings::options() const {
  check();
  return options_of(*this);
}

}  // namespace palmar::grasp
