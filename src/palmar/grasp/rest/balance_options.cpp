// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/grasp/rest/balance.h"

namespace palmar::grasp {

std::optional<double> BalanceOptions::asked_grip_force(Grip grip) const {
  if (!is_on || grip == Grip::kFixedHook || turn) return std::nullopt;
  if (is_laid(grip)) return grip_force.value_or(kRestingForce);
  if (holds_load) {
    const double needed =
        holding_grip_force(contact::wrench_of(load, Vec3::Zero()).force.norm(), friction);
    return needed > 0.0 ? std::optional(needed) : std::nullopt;
  }
  if (share_of_strength) return share_of_strength->force(grip);
  return grip_force;
}

std::string BalanceOptions::asked_words(Grip grip) const {
  if (!is_on) return "as the hand was closed to the limit depths";
  if (turn) {
    return fmt::format("what turning it with {:g} N m takes, with {:g} times what friction needs",
                       1e-3 * *turn, kGripMargin);
  }
  if (grip == Grip::kFixedHook) return "hooked fingers carry and don't squeeze";
  if (is_laid(grip) && !grip_force) {
    return "the weight of a hand and its share of the forearm's (Winter 2009)";
  }
  if (holds_load && asked_grip_force(grip)) {
    return fmt::format(
        "what its load asks for of two opposed contacts, {:g} times what friction needs (Westling "
        "& Johansson 1984)",
        kGripMargin);
  }
  if (share_of_strength) return share_of_strength->words(grip);
  return grip_force ? "as given" : "as firm as closing to the limit depths";
}

void BalanceOptions::check() const {
  if (!(strength >= 0.01 && strength <= 10.0)) {
    throw UsageError(fmt::format("balance: strength is {}; 0.01 to 10 is allowed", strength));
  }
  wrist.check();
  if (activation && !(*activation > 0.0 && *activation <= strength)) {
    throw UsageError(
        fmt::format("balance: activation is {}; above 0, up to strength ({}), is allowed",
                    *activation, strength));
  }
  if (holds_load && (grip_force || share_of_strength || activation)) {
    throw UsageError("balance: it is asked to hold its load, and how firmly; one is allowed");
  }
  if (turn && (holds_load || grip_force || share_of_strength)) {
    throw UsageError("balance: it is asked to turn, and how firmly; one is allowed");
  }
  if (turn && !(std::abs(*turn) > 0.0 && std::abs(*turn) <= kMostTurn)) {
    throw UsageError(
        fmt::format("balance: turn is {:g} N mm; not 0, and at most {:g} N mm either "
                    "way, is allowed",
                    *turn, kMostTurn));
  }
  if (grip_force && share_of_strength) {
    throw UsageError("balance: grip force and share of strength are both given; one is allowed");
  }
  if (!(friction >= 0.0 && friction <= 5.0)) {
    throw UsageError(fmt::format("balance: friction is {:g}; 0 to 5 is allowed", friction));
  }
  if (grip_force && !(*grip_force > 0.0 && *grip_force <= 2000.0)) {
    throw UsageError(fmt::format(
        "balance: grip force is {:g} N; more than 0 and at most 2000 N is allowed", *grip_force));
  }
  contact::FrictionOptions with_load;
  with_load.coefficient = 1.0;
  with_load.load = load;
  with_load.check();
}

std::string_view name_of(BalanceStatus status) {
  switch (status) {
    case BalanceStatus::kOff:
      return "off";
    case BalanceStatus::kBalanced:
      return "balanced";
    case BalanceStatus::kSlipsOut:
      return "slips_out";
    case BalanceStatus::kSupported:
      return "supported";
    case BalanceStatus::kNoContact:
      return "no_contact";
    case BalanceStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

}  // namespace palmar::grasp
