// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/study/study_run.h"

namespace palmar::redesign {

/// One hand at rest on a product, as a redesign sees it.
struct HeldHand {
  int hand = 0;                           ///< index into StudyPlan::hands
  std::shared_ptr<const hand::Hand> who;  ///< scaled, with its profile
  geometry::Rigid3 product_from_hand;
  geometry::TriangleMesh skin;          ///< posed, not deformed by the contact; product frame, mm
  std::vector<double> pressure;         ///< MPa, per vertex of the skin
  study::SparseField product_pressure;  ///< MPa, per vertex of product_map()
};

/// Gives every hand that has product `product` (index) in the hand under `condition` to `visit`,
/// ascending by hand. `records` come with their fields. Hands are made again from their dimensions
/// on the threads of thread_count(); the same whatever their number. Throws UsageError if no hand
/// holds the product; Cancelled.
void for_each_held_hand(const study::StudyPlan& plan, const study::StudyInputs& inputs,
                        const study::RecordSource& records, const study::StudyCondition& condition,
                        int product, const std::function<void(const HeldHand&)>& visit,
                        const Progress& progress = {});

}  // namespace palmar::redesign
