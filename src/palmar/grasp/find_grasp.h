// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/precision/precision_grip.h"

namespace palmar {

/// Any grip.
struct GraspOptions {
  std::optional<Grip> grip;        ///< unset: the power grip that suits the product's shape
  PowerGraspOptions power;         ///< for power grips
  PrecisionGripOptions precision;  ///< for the others; its grip is replaced by `grip`
  void check() const;              ///< throws UsageError
};

/// Holds the product by the grip asked for: close_power_grasp() or close_precision_grip().
Grasp find_grasp(const Hand& hand, const Product& product, const GraspOptions& options = {},
                 const Progress& progress = {});

}  // namespace palmar
