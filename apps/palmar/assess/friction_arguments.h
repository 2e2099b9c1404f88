// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::cli {

inline constexpr double kUsualFriction = 0.5;  ///< of skin; see BalanceOptions

/// The options of friction, as typed.
struct FrictionArguments {
  std::optional<double> coefficient, mass_kg, weight_n, density;
  std::string gravity, mass_at, load_n, torque_n_mm, load_at;

  /// Adds --friction, --mass-kg, --weight-n, --gravity, --mass-at, --load-n, --torque-n-mm and
  /// --load-at to a verb.
  void add_to(CLI::App& verb);
  /// Throws UsageError. A load without --friction gets the coefficient of kUsualFriction.
  FrictionOptions options() const;
  /// With what depends on the product: the weight from --density-g-cm3. Throws InputError if the
  /// weight or where it acts need a volume that the product doesn't have.
  FrictionOptions options_for(const Product& product) const;
  bool has_load() const;
};

/// Whether the load is held, and one line per region; empty if friction is off.
std::string friction_text(const Hand& hand, const Assessment& assessment);

}  // namespace palmar::cli
