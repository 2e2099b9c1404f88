// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "palmar/contact/hand_family.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/product/product.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"

namespace palmar::study {

/// What a study needs beside its plan.
struct StudyInputs {
  std::shared_ptr<const hand::Hand> base;  ///< the hand that is scaled
  std::vector<product::Product> products;  ///< as StudyPlan::products, mm, `size` applied
  /// Of `base`, for plans with tissue on bone (skin_compliance.h); none: made when needed.
  std::shared_ptr<const contact::SkinCompliance> compliance = nullptr;
  /// Of `base`, for settings with its model; none: made when needed.
  std::shared_ptr<const contact::HandFamily> family = nullptr;
  /// As `products`: their parts, where they are known; null or too few: found when needed.
  std::vector<std::shared_ptr<const product::ProductParts>> parts = {};
};

/// What a record has.
enum class StudyDetail {
  kAll,
  kFigures  ///< no pressures on skin and product: quicker
};

struct StudyRunOptions {
  std::vector<std::int64_t> tasks;  ///< to run, ascending; those already finished are left out
};

class StudyBench;

/// Runs tasks on the threads of thread_count(), a hand per thread, and gives every finished grasp
/// to `keep` (one call at a time, from any thread, in the order in which they end). Records don't
/// depend on threads, order, or which other tasks run. A grasp that fails is a record with its
/// reason. Throws Cancelled when asked to stop, after the records that are finished were kept;
/// whatever `keep` throws ends the run.
void run_study(const StudyPlan& plan, const StudyInputs& inputs, const StudyRunOptions& options,
               const std::function<void(const StudyRecord&)>& keep, const Progress& progress = {});
/// The same on a bench of `plan` that is kept for more tasks.
void run_study(StudyBench& bench, const StudyPlan& plan, const StudyRunOptions& options,
               const std::function<void(const StudyRecord&)>& keep, const Progress& progress = {});

}  // namespace palmar::study
