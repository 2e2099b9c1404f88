// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"
#include "palmar/study/study_run.h"

namespace palmar::study {

/// What all grasps of a study share: the maps on the products, and where each product is held,
/// found on the study's mean hand (StudySetting::is_place_per_hand). May be used from many threads.
class StudyBench {
 public:
  /// `plan` and `inputs` must outlive it. Throws UsageError: a plan that doesn't check, or other
  /// products than the plan's.
  StudyBench(const StudyPlan& plan, const StudyInputs& inputs,
             StudyDetail detail = StudyDetail::kAll);
  ~StudyBench();

  /// What hands share, to be called once before run_hand() with all of its tasks: where the mean
  /// hand holds the products, and what preparing one hand has in common with the next. On all
  /// threads. Throws Cancelled.
  void prepare(std::span<const std::int64_t> tasks, const Progress& progress);

  /// Runs tasks of one hand, ascending; the hand is scaled and prepared once per profile and
  /// equations. Every task gives a record to `keep`: what goes wrong is a record that failed and
  /// says why. Throws Cancelled, std::bad_alloc and what `keep` throws, nothing else.
  void run_hand(int hand, std::span<const std::int64_t> tasks,
                const std::function<void(const StudyRecord&)>& keep, const Progress& progress);

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// The study's mean hand: every dimension that all hands have, at its mean over them.
std::vector<hand::SizedDimension> mean_dimensions(const StudyPlan& plan);

/// A field of a mesh without its zeros, in single precision.
SparseField sparse(const std::vector<double>& field);
/// With zeros, `size` values long.
std::vector<double> dense(const SparseField& field, std::size_t size);

}  // namespace palmar::study
