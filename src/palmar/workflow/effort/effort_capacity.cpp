// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort_capacity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "palmar/core/error.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/task_force.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/study/assessment/held_torque.h"
#include "palmar/workflow/grasp/grasp.h"
#include "palmar/workflow/grasp/hold_product.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {
namespace {

// Where the product leaves a hand that grips as hard as it can: grip forces that are tried, over
// the person's strength, and how often the last step is halved.
constexpr std::array<double, 7> kShares = {0.4, 0.3, 0.22, 0.15, 0.1, 0.06, 0.03};
constexpr int kHalvings = 3;
// How far above the firmest hold found a firmer one is looked for at a time, and how often.
constexpr int kMostRaises = 4;  // of the force asked for, by a fifth each
constexpr double kRaise = 1.2, kWorthRaising = 1.005;
constexpr double kExhausted = 0.9;  // of the strength: from there on muscles limit; our choice
constexpr double kReached = 0.98;   // of the force asked for; less isn't held with it

double strength_of(const CapacityRequest& request) {
  const double grip = request.strength ? *request.strength
                      : request.person
                          ? *grasp::grip_strength(request.person->sex, request.person->age)
                          : grasp::usual_grip_strength();
  return grip / grasp::usual_grip_strength();
}

bool squeezes(grasp::Grip grip) { return grasp::is_power(grip) && grip != grasp::Grip::kFixedHook; }

std::string refusal(grasp::Grip grip) {
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
  wrist.check();
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
  if (torque_axis && !(torque_axis->norm() > 0.0)) {
    throw UsageError("setting \"torque axis\" is 0,0,0; a direction is required");
  }
  if (person && !grasp::grip_strength(person->sex, person->age)) {
    throw UsageError(
        fmt::format("setting \"person\": no grip strength is known for {:g} years; 17 to 90 is "
                    "allowed, or give setting \"strength\"",
                    person->age));
  }
}

Capacity capacity_of_grip(const CapacityRequest& request, const Progress& progress) {
  request.check();
  const product::Product product = load_product(request.product);
  for (const std::string& text : product.notes) note_to(request.note, text);
  study::AssessOptions options;
  options.grasp = options_for(request.grasp, product);
  options.contact = request.contact;
  options.contact.error_band = false;
  options.indices.is_on = false;
  options.footprint = false;
  const auto hand = load_hand(request.hand);
  const contact::PreparedHand prepared =
      prepared_hand(request.hand, hand, request.model, request.note);
  const grasp::Grasp grasp = hold_product(hand, product, request.grasp, options.grasp, progress);
  if (!squeezes(grasp.grip)) {
    throw UsageError(
        fmt::format("{} is held in a grip of another kind: {}", product.name, refusal(grasp.grip)));
  }
  Capacity result;
  result.strength = strength_of(request);
  result.hold = grasp.hold_words;
  result.grip = std::string(name_of(grasp.grip));
  result.axis = grasp.grip_axis.normalized();
  result.torque_axis = request.torque_axis.value_or(result.axis).normalized();
  grasp::BalanceOptions& rest = options.balance;
  rest.friction = request.friction.friction.value_or(grasp::kUsualFriction);
  rest.strength = result.strength;
  rest.wrist = request.wrist;
  result.friction = rest.friction;

  struct Tried {
    bool is_held = false;
    study::Assessment assessment;
  };
  // `asked`: N; nothing: as hard as the muscles can.
  const auto gripped = [&](std::optional<double> asked) {
    progress.throw_if_cancelled();
    rest.activation = asked ? std::nullopt : std::optional(result.strength);
    rest.grip_force = asked;
    Tried tried;
    tried.assessment =
        study::assess(prepared, product, options, progress, [&](const Progress&) { return grasp; });
    const grasp::Balance& balance = tried.assessment.balance;
    tried.is_held = balance.status == grasp::BalanceStatus::kBalanced && balance.strength_use &&
                    balance.grip_force >= kReached * asked.value_or(0.0);
    return tried;
  };
  if (grasp.status == grasp::GraspStatus::kNotGraspable ||
      grasp.status == grasp::GraspStatus::kTooLarge ||
      grasp.status == grasp::GraspStatus::kTooSmall) {
    result.limited_by = "reach";
    result.message = grasp.message;
    return result;
  }
  Tried best = gripped(std::nullopt);
  double lost = 0.0;
  for (std::size_t i = 0; i < kShares.size() && !best.is_held; ++i) {
    const double asked = kShares[i] * grasp::usual_grip_strength() * result.strength;
    best = gripped(asked);
    if (!best.is_held) lost = asked;
  }
  if (!best.is_held) {
    result.limited_by = "reach";
    result.message =
        "the fingers can't press the product into the palm: " + best.assessment.balance.message;
    return result;
  }
  for (int i = 0; i < kHalvings && lost > 0.0; ++i) {
    const double middle = 0.5 * (best.assessment.balance.grip_force + lost);
    Tried tried = gripped(middle);
    if (tried.is_held) {
      best = std::move(tried);
    } else {
      lost = middle;
    }
  }
  // The search is local: asked for more, it may go another way and come farther.
  for (int i = 0; i < kMostRaises && lost == 0.0; ++i) {
    const double reached = best.assessment.balance.grip_force;
    Tried more = gripped(kRaise * reached);
    if (more.assessment.balance.status != grasp::BalanceStatus::kBalanced ||
        more.assessment.balance.grip_force < kWorthRaising * reached) {
      break;
    }
    best = std::move(more);
  }
  const study::Assessment& firmest = best.assessment;
  result.activation = *firmest.balance.strength_use;
  result.grip_force = firmest.balance.grip_force;
  const bool is_by_wrist = firmest.balance.is_by_wrist;
  const bool is_exhausted = result.activation >= kExhausted;
  result.limited_by = !is_exhausted ? "slips" : is_by_wrist ? "wrist" : "muscles";
  result.message =
      is_exhausted ? (is_by_wrist ? "the muscles that hold the wrist can't bear more"
                                  : "no muscle could add to it")
                   : fmt::format("gripped harder than with {:.0f} N, the product leaves the hand",
                                 result.grip_force);
  if (rest.friction <= 0.0) return result;
  const auto held_load = [&](const contact::ProductLoad& load) {
    progress.throw_if_cancelled();
    contact::FrictionOptions friction;
    friction.coefficient = rest.friction;
    friction.load = load;
    const contact::FrictionResult solved = contact::solve_friction(
        prepared, firmest.contact, *product.distance, grasp.grip_point, friction);
    return solved.load_factor.value_or(0.0);
  };
  const auto held_force = [&](const Vec3& along) {
    constexpr double kUnit = 10.0;  // N
    contact::ProductLoad load;
    load.force = kUnit * along;
    load.force_at = grasp.grip_point;
    return kUnit * held_load(load);
  };
  result.torque =
      study::held_torque(prepared, firmest.contact, *product.distance,
                         {.axis = result.torque_axis, .at = grasp.grip_point}, rest.friction);
  progress.throw_if_cancelled();
  // What the product bears against the hand's push comes from the thumb's side.
  result.push = held_force(-result.axis);
  result.pull = held_force(result.axis);
  return result;
}

}  // namespace palmar::workflow
