// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::cli {

/// The options of friction and load.
class FrictionArguments {
 public:
  /// Adds --friction, --mass-kg, --weight-n, --density-g-cm3, --acceleration-g, --gravity,
  /// --mass-at, --load-n, --torque-n-mm and --load-at to a verb.
  void add_to(CLI::App& verb);
  grasp::FrictionSettings settings() const;  ///< throws UsageError naming the option

 private:
  grasp::FrictionSettings settings_;
  std::string gravity_, mass_at_, load_n_, torque_n_mm_, load_at_;
};

/// Whether the load is held, and one line per region; empty if friction is off.
std::string friction_text(const hand::Hand& hand, const study::Assessment& assessment);

}  // namespace palmar::cli
