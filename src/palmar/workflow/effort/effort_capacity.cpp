// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort_capacity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "palmar/core/error.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/rest/task_force.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/grasp.h"
#include "palmar/workflow/grasp/hold_product.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar {
namespace {

// Shares of the person's strength that are tried, and how often the last step is halved.
constexpr std::array<double, 7> kShares = {1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.08};
constexpr int kHalvings = 3;

double strength_of(const CapacityRequest& request) {
  const double grip = request.strength ? *request.strength
                      : request.person ? *grip_strength(request.person->sex, request.person->age)
                                       : usual_grip_strength();
  return grip / usual_grip_strength();
}

bool squeezes(Grip grip) { return is_power(grip) && grip != Grip::kFixedHook; }

std::string refusal(Grip grip) {
  return fmt::format(
      "setting \"grip\" is {}; what muscles can do at most is computed for power grips, in which "
      "fingers press against the palm (power, medium_wrap, large_diameter, small_diameter or "
      "power_sphere)",
      name_of(grip));
}

}  // namespace

void CapacityRequest::check() const {
  if (grasp.grip && !squeezes(*grasp.grip)) throw UsageError(refusal(*grasp.grip));
  product.check();
  grasp.check();
  contact.check();
  friction.options();
  if (strength && person) {
    throw UsageError(
        "setting \"strength\" and setting \"person\" both say how strong the user is; one is "
        "allowed");
  }
  if (strength && !(*strength >= 10.0 && *strength <= 2000.0)) {
    throw UsageError(fmt::format(
        "setting \"strength\" is {:g} N; 10 to 2000 N is allowed (a grip dynamometer's reading)",
        *strength));
  }
  if (person && !grip_strength(person->sex, person->age)) {
    throw UsageError(
        fmt::format("setting \"person\": no grip strength is known for {:g} years; 17 to 90 is "
                    "allowed, or give setting \"strength\"",
                    person->age));
  }
}

Capacity capacity_of_grip(const CapacityRequest& request, const Progress& progress) {
  request.check();
  const Product product = load_product(request.product);
  for (const std::string& text : product.notes) note_to(request.note, text);
  AssessOptions options;
  options.grasp = options_for(request.grasp, product);
  options.contact = request.contact;
  options.contact.error_band = false;
  options.indices.is_on = false;
  options.footprint = false;
  const auto hand = load_hand(request.hand);
  const PreparedHand prepared = prepared_hand(request.hand, hand, request.model);
  const Grasp grasp = hold_product(hand, product, request.grasp, options.grasp, progress);
  if (!squeezes(grasp.grip)) {
    throw UsageError(
        fmt::format("{} is held in a grip of another kind: {}", product.name, refusal(grasp.grip)));
  }
  Capacity result;
  result.strength = strength_of(request);
  result.hold = grasp.hold_words;
  result.grip = std::string(name_of(grasp.grip));
  result.axis = grasp.grip_axis.normalized();
  BalanceOptions& rest = options.balance;
  rest.friction = request.friction.friction.value_or(kUsualFriction);
  rest.strength = result.strength;
  result.friction = rest.friction;

  struct Tried {
    bool is_held = false;
    Assessment assessment;
  };
  const auto at_share = [&](double share) {
    progress.throw_if_cancelled();
    rest.activation = share * result.strength;
    Tried tried;
    tried.assessment =
        assess(prepared, product, options, progress, [&](const Progress&) { return grasp; });
    tried.is_held = tried.assessment.balance.status == BalanceStatus::kBalanced &&
                    tried.assessment.balance.strength_use.has_value();
    return tried;
  };
  if (grasp.status == GraspStatus::kNotGraspable || grasp.status == GraspStatus::kTooLarge ||
      grasp.status == GraspStatus::kTooSmall) {
    result.limited_by = "reach";
    result.message = grasp.message;
    return result;
  }
  Tried best;
  double held = 0.0, lost = 0.0;
  for (const double share : kShares) {
    best = at_share(share);
    if (best.is_held) {
      held = share;
      break;
    }
    lost = share;
  }
  for (int i = 0; i < kHalvings && held > 0.0 && lost > 0.0; ++i) {
    const double middle = 0.5 * (held + lost);
    Tried tried = at_share(middle);
    (tried.is_held ? held : lost) = middle;
    if (tried.is_held) best = std::move(tried);
  }
  if (held == 0.0) {
    result.limited_by = "reach";
    result.message =
        "the fingers can't press the product into the palm: " + best.assessment.balance.message;
    return result;
  }
  const Assessment& firmest = best.assessment;
  result.activation = held;
  result.grip_force = firmest.balance.grip_force;
  result.limited_by = held == 1.0 ? "muscles" : "slips";
  result.message =
      held == 1.0 ? "all muscles that close the fingers are at their full strength"
                  : fmt::format(
                        "gripped harder than with {:.0f} % of the muscles' strength, the product "
                        "leaves the hand",
                        100.0 * held);
  if (rest.friction <= 0.0) return result;
  const auto held_load = [&](const ProductLoad& load) {
    progress.throw_if_cancelled();
    FrictionOptions friction;
    friction.coefficient = rest.friction;
    friction.load = load;
    const FrictionResult solved =
        solve_friction(prepared, firmest.contact, *product.distance, grasp.grip_point, friction);
    return solved.load_factor.value_or(0.0);
  };
  std::array<double, 2> torque{}, along{};
  for (const int sense : {0, 1}) {
    const Vec3 axis = sense == 0 ? result.axis : Vec3(-result.axis);
    ProductLoad load;
    load.torque = 1000.0 * axis;  // N mm
    torque[static_cast<std::size_t>(sense)] = 1000.0 * held_load(load);
    load.torque = Vec3::Zero();
    load.force = 10.0 * axis;  // N
    load.force_at = grasp.grip_point;
    along[static_cast<std::size_t>(sense)] = 10.0 * held_load(load);
  }
  result.torque = std::min(torque[0], torque[1]);
  result.force_along = std::min(along[0], along[1]);
  return result;
}

}  // namespace palmar
