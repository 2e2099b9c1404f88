// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"

namespace palmar {

/// What a study needs beside its plan.
struct StudyInputs {
  std::shared_ptr<const Hand> base;  ///< the hand that is scaled
  std::vector<Product> products;     ///< as StudyPlan::products, mm, `size` applied
  /// Of `base`, for plans with tissue on bone (skin_compliance.h); none: made when needed.
  std::shared_ptr<const SkinCompliance> compliance = nullptr;
};

struct StudyRunOptions {
  std::vector<std::int64_t> tasks;  ///< to run, ascending; those already finished are left out
};

/// Runs tasks on the threads of thread_count(), a hand per thread, and gives every finished grasp
/// to `keep` (one call at a time, from any thread, in the order in which they end). Records don't
/// depend on threads, order, or which other tasks run. A grasp that fails is a record with its
/// reason. Throws Cancelled when asked to stop, after the records that are finished were kept;
/// whatever `keep` throws ends the run.
void run_study(const StudyPlan& plan, const StudyInputs& inputs, const StudyRunOptions& options,
               const std::function<void(const StudyRecord&)>& keep, const Progress& progress = {});

}  // namespace palmar
