// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/find_grasp.h"

namespace palmar {

/// How a product is to be held, in the terms of any grip; GraspOptions is what becomes of it.
struct GraspSettings {
  std::optional<Grip> grip;    ///< unset: the power grip that suits the product's shape
  PlacementRequest placement;  ///< where and how; empty: found by a search
  double palm_limit_depth = PowerGraspOptions{}.palm_limit_depth;      ///< power grips, mm
  double finger_limit_depth = PowerGraspOptions{}.finger_limit_depth;  ///< power grips, mm
  double fingertip_depth = PrecisionGripOptions{}.fingertip_depth;     ///< precision grips, mm
  std::vector<FingertipTarget> fingertips;  ///< precision grips only; empty: found from the shape
  /// Each hand searches where to hold the product, instead of holding it where the built-in hand
  /// does.
  bool is_place_per_hand = false;

  /// Throws UsageError: setting, value, what is allowed. Fingertips go with precision grips only, a
  /// region of the surface with power grips only.
  void check() const;
  GraspOptions options() const;  ///< throws UsageError as check()
};

}  // namespace palmar
