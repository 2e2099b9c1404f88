// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palmar/core/progress.h"
#include "palmar/records/study/study_file.h"

namespace palmar::workflow {

/// What a few grasps of a study took here, on one thread, and what the whole will take.
struct StudyEstimate {
  double seconds_once = 0.0;       ///< to read what is needed and find the places of the grips
  double seconds_per_hand = 0.0;   ///< all grasps of one hand, on one thread
  double memory_once = 0.0;        ///< MB
  double memory_per_thread = 0.0;  ///< MB
  int sample = 0;                  ///< grasps that were run for it

  double seconds(std::int64_t hands, int threads) const;
  double memory(int threads) const;  ///< MB
};
/// Runs the first grasps of the study's first hand. Throws Cancelled.
StudyEstimate estimate_study(const records::LoadedStudy& study, const Progress& progress = {});

}  // namespace palmar::workflow
