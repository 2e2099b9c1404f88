// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/rest_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

std::string person_words(const PersonOfAge& person) {
  return fmt::format("{} of {:g} years (mean; Steiber 2016)",
                     person.sex == Sex::kMale ? "men" : "women", person.age);
}

}  // namespace

void RestSettings::check() const {
  if ((task == HandTask::kTurn) != turn.has_value()) {
    throw UsageError(
        turn ? "setting \"turn n m\" is given; setting \"task\" is required with it, as turn"
             : "setting \"task\" is \"turn\"; setting \"turn n m\", a torque, is "
               "required with it");
  }
  if (strength && person) {
    throw UsageError(
        "setting \"strength\" and setting \"person\" both say how strong the user is; one is "
        "allowed");
  }
  const bool has_strength = strength || person;
  if (has_strength != strength_share.has_value()) {
    throw UsageError(
        has_strength ? "setting \"strength\" and setting \"person\" say how strong the user is; "
                       "setting \"strength share\" is required with them"
                     : "setting \"strength share\" needs setting \"person\" or setting "
                       "\"strength\"");
  }
  if (grip_force && strength_share) {
    throw UsageError(
        "setting \"grip force\" and setting \"strength share\" both say how firmly to grip; one is "
        "allowed");
  }
  const bool is_firm = limit_depths || grip_force || strength_share || !is_balanced;
  if (says_how_firmly(task) && is_firm) {
    throw UsageError(fmt::format(
        "setting \"task\" is \"{}\", which asks for no more than {} takes, and setting \"{}\" says "
        "how firmly to grip; one is allowed",
        name_of(task), turn ? "the torque" : "the load",
        limit_depths   ? "limit depths"
        : grip_force   ? "grip force"
        : !is_balanced ? "no balance"
                       : "strength share"));
  }
  if (turn && !(std::abs(*turn) > 0.0 && std::abs(*turn) <= 1e-3 * kMostTurn)) {
    throw UsageError(
        fmt::format("setting \"turn\" is {:g} N m; not 0, and at most {:g} N m either "
                    "way, is allowed",
                    *turn, 1e-3 * kMostTurn));
  }
  if (limit_depths && (grip_force || strength_share)) {
    throw UsageError(
        fmt::format("setting \"limit depths\" and setting \"{}\" both say how firmly to grip; one "
                    "is allowed",
                    grip_force ? "grip force" : "strength share"));
  }
  if (!is_balanced && limit_depths) {
    throw UsageError(
        "setting \"limit depths\" lets the grasp come to rest as firmly as it was closed, setting "
        "\"no balance\" leaves it as it was closed; one is allowed");
  }
  if (!is_balanced && (grip_force || strength_share)) {
    throw UsageError(
        "setting \"no balance\" keeps the hand at its limit depths; a grip force can't be given "
        "with it");
  }
  if (strength_share && !(*strength_share > 0.0 && *strength_share <= 1.0)) {
    throw UsageError(
        fmt::format("setting \"strength share\" is {}; more than 0 and at most 1 is required",
                    *strength_share));
  }
  if (person && !grasp::grip_strength(person->sex, person->age)) {
    throw UsageError(
        fmt::format("setting \"person\": no grip strength is known for {:g} years; 17 to 90 is "
                    "allowed, or give setting \"strength\"",
                    person->age));
  }
}

BalanceOptions RestSettings::options(std::optional<double> friction,
                                     const HeaviestLoad& heaviest) const {
  check();
  BalanceOptions result;
  result.is_on = is_balanced;
  result.holds_load = holds_load(task);
  if (turn) result.turn = 1e3 * *turn;
  result.friction = friction.value_or(kUsualFriction);
  result.grip_force = grip_force;
  if (strength_share) {
    ShareOfStrength& share = result.share_of_strength.emplace();
    share.share = *strength_share;
    share.strength = strength ? *strength : *grasp::grip_strength(person->sex, person->age);
    if (person) share.whose = person_words(*person);
    result.strength = std::clamp(share.strength / usual_grip_strength(), 0.01, 10.0);
    if (is_share_usual) share.take_least(result.friction, heaviest);
  } else if (is_usual()) {
    result.share_of_strength = usual_share(result.friction, heaviest);
  }
  result.check();
  return result;
}

FrictionSettings RestSettings::load(FrictionSettings given) const {
  if (holds_load(task) && !given.has_load()) given.density = kAssumedDensity;
  if (task == HandTask::kCarry && given.has_weight() && !given.acceleration) {
    given.acceleration = kWalking;
  }
  return given;
}

}  // namespace palmar::grasp
