// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/grasp/find/find_grasp.h"

namespace palmar::grasp {

/// How a product is to be held, said without coordinates; unset fields are found from its shape.
struct HoldRequest {
  std::optional<Hold> hold;     ///< the hold itself
  std::optional<int> number;    ///< which of the ranked holds, from 1; unset: the best
  std::optional<int> part;      ///< hold this part (ProductPart::number)
  std::string part_name;        ///< hold a part of this name: "handle"; "": any
  std::optional<double> along;  ///< where along the part, a fraction of its length, 0 to 1
  std::optional<Vec3> toward;   ///< where the thumb's side is to point, product frame
  std::optional<Vec3> up;  ///< the product's up where it is taken, product frame; unset: unknown
  HoldPurpose purpose = HoldPurpose::kUse;
  std::shared_ptr<const HoldWeights> weights;  ///< as HoldOptions has them

  bool is_empty() const;                       ///< nothing is said
  void apply_to(GraspOptions& options) const;  ///< what is said, into the options of a grasp
};

/// How a product is to be held, in the terms of any grip; GraspOptions is what becomes of it.
struct GraspSettings {
  std::optional<Grip> grip;    ///< unset: as people would choose for the product's shape
  bool is_power_only = false;  ///< with `grip` unset: none of the precision grips
  PlacementRequest placement;  ///< where and how; empty: found by a search
  double palm_limit_depth = PowerGraspOptions{}.palm_limit_depth;      ///< power grips, mm
  double finger_limit_depth = PowerGraspOptions{}.finger_limit_depth;  ///< power grips, mm
  double fingertip_depth = PrecisionGripOptions{}.fingertip_depth;     ///< precision grips, mm
  std::vector<FingertipTarget> fingertips;  ///< precision grips only; empty: found from the shape
  HoldRequest holding;                      ///< by which part and how, in place of coordinates
  /// Each hand searches where to hold the product, instead of holding it where the built-in hand
  /// does.
  bool is_place_per_hand = false;

  /// Throws UsageError: setting, value, what is allowed. Fingertips go with precision grips only, a
  /// region of the surface with power grips only; a hold is said in one way: by itself or its
  /// number, by part, place and direction, or by coordinates.
  void check() const;
  GraspOptions options() const;  ///< throws UsageError as check()
};

}  // namespace palmar::grasp
