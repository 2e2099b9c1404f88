// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "assess/friction_arguments.h"
#include "cli.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::cli {

/// How firmly the hand grips and whether the grasp comes to rest, as typed.
struct BalanceArguments {
  bool no_balance = false;
  std::optional<double> grip_force_n, strength_share, strength_n;
  std::string person;

  /// Adds --no-balance, --grip-force-n, --strength-share, --strength-n and --person to a verb.
  void add_to(CLI::App& verb);
  /// `grip` turns a share of the grip strength into that of a pinch; unset: a power grip. Throws
  /// UsageError.
  BalanceOptions options(const FrictionArguments& friction, std::optional<Grip> grip) const;
};

/// How the grasp came to rest, in one or two lines; empty if it wasn't asked to.
std::string balance_text(const Balance& balance);

}  // namespace palmar::cli
