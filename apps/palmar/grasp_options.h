// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "cli.h"
#include "palmar/contact/contact.h"
#include "palmar/grasp/grasp.h"

namespace palmar::cli {

/// The options by which assess and grasp place and close the hand, as typed.
struct GraspArguments {
  std::string hand = "template", grip = "power", unit, at, axis;
  std::optional<double> turn_deg;
  double palm_limit_depth = PowerGraspOptions{}.palm_limit_depth;
  double finger_limit_depth = PowerGraspOptions{}.finger_limit_depth;

  /// Adds --hand, --grip, --unit, --at, --axis, --turn-deg and the limit depths to a verb.
  void add_to(CLI::App& verb);
  /// The values for the grasp module. Throws UsageError.
  PowerGraspOptions options() const;
};

/// The options of the contact solver, as typed.
struct ContactArguments {
  std::string kernel = "patch";
  bool no_swelling = false;
  std::optional<double> shear_modulus_kpa;

  /// Adds --kernel, --no-swelling and --shear-modulus-kpa to a verb.
  void add_to(CLI::App& verb);
  ContactOptions options() const;
  /// The equations for PreparedHand. Throws UsageError.
  ContactModel model() const;
};

/// "patch" or "point". Throws UsageError naming --kernel.
Kernel parse_kernel(const std::string& text);

}  // namespace palmar::cli
