// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/holds/hold.h"
#include "palmar/grasp/precision/precision_grip.h"

namespace palmar::grasp {

/// How a product is to be taken: by a hold, or where coordinates say (a placement of `power`, or
/// targets or a placement of `precision`).
struct GraspOptions {
  std::optional<Grip> grip;  ///< unset: as people would choose for the product's shape
  std::optional<Hold> hold;  ///< this one; unset: one of rank_holds()
  /// Of the product, for `hold`, where they are known; null: found when needed.
  std::shared_ptr<const product::ProductParts> parts = nullptr;
  HoldOptions holds;  ///< which holds to choose from; its grip is replaced by `grip`
  /// Which of the holds, from 1; unset: the best.
  std::optional<int> hold_rank;
  /// N that it is to be gripped with, whatever the grip: of ranked holds the one that suits it
  /// (firm_hold()), unless `hold_rank` says which. Unset: as usual in each grip.
  std::optional<double> grip_force;
  PowerGraspOptions power;         ///< for power grips
  PrecisionGripOptions precision;  ///< for the others; its grip is replaced by `grip`

  /// Whether coordinates say where the hand goes.
  bool is_placed() const;
  /// Whether nothing says which of the ranked holds is to be taken.
  bool leaves_hold_open() const;
  void check() const;  ///< throws UsageError
};

/// Holds the product as asked for. Not being able to is a status, never an exception. Throws
/// UsageError (also if there are fewer holds than `hold_rank`), Cancelled.
Grasp find_grasp(const hand::Hand& hand, const product::Product& product,
                 const GraspOptions& options = {}, const Progress& progress = {});

/// Power grasp (docs/method/grasp.md; Xie 2014, 5.5.1). Deterministic. Not being able to hold the
/// product is a status, never an exception. Throws UsageError on bad options, Cancelled.
Grasp close_power_grasp(const hand::Hand& hand, const product::Product& product,
                        const PowerGraspOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::grasp
