// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/report/chart/study_figures.h"
#include "palmar/study/statistics/study_analysis.h"
#include "palmar/workflow/redesign/candidate_study.h"
#include "palmar/workflow/redesign/held_original.h"
#include "palmar/workflow/redesign/hold_change.h"

namespace palmar::workflow {

/// Original and redesigns in the same hands.
struct RedesignComparison {
  study::StudyResults results;                   ///< product 0 is the original; without fields
  std::vector<study::StudyQuantity> quantities;  ///< that are compared in words; the report has all
  std::filesystem::path report;                  ///< report.html
  std::filesystem::path study;                   ///< store of the study
  Language language = Language::kEnglish;        ///< of the report
  bool is_in_other_hands = false;                ///< than those that the redesign was made for
  std::vector<HoldChange> changes;               ///< one per redesign
  std::vector<std::string> notes;                ///< those two in sentences
};
/// The last step of every redesign: original and redesigns in the hands that judge. Redesigns are
/// held as the original is: the same hold, the same grip force, or the posture kept. Writes
/// OUT/redesign.palmar and OUT/report/, with `figures` besides its own.
RedesignComparison compare_redesigns(const RedesignRequest& request, const JudgingHands& judges,
                                     const std::vector<RedesignedProduct>& redesigns,
                                     const std::vector<report::StudyFigure>& figures,
                                     const Progress& progress);

}  // namespace palmar::workflow
