// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/records/study/study_file.h"
#include "palmar/study/statistics/study_analysis.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/workflow/redesign/redesign_request.h"

namespace palmar {

/// The original in the hands.
struct HeldOriginal {
  LoadedStudy study;                 ///< with one product, one condition
  std::vector<StudyRecord> records;  ///< with fields, ascending
  const Product& product() const { return study.inputs.products.front(); }
  RecordSource source() const;  ///< of `records`, which must outlive it
};
/// Loads, draws and grasps. Throws as RedesignRequest::check() and load_study(), NumericalError if
/// no hand holds the product: no answer; Cancelled.
HeldOriginal grasp_original(const RedesignRequest& request, const Progress& progress);

/// A redesigned product with what is to be said of it.
struct RedesignedProduct {
  Product product;
  std::string name;  ///< "pressed", "fillet 8 mm"
  std::string file;  ///< that was written
};

/// Original and redesigns in the same hands.
struct RedesignComparison {
  StudyResults results;                    ///< product 0 is the original; without fields
  std::vector<StudyQuantity> quantities;   ///< that are compared in words; the report has all
  std::filesystem::path report;            ///< report.html
  std::filesystem::path study;             ///< store of the study
  Language language = Language::kEnglish;  ///< of the report
};
/// The last step of every redesign: the same hands hold the original and the redesigns. Writes
/// OUT/redesign.palmar and OUT/report/.
RedesignComparison compare_redesigns(const RedesignRequest& request, const HeldOriginal& original,
                                     const std::vector<RedesignedProduct>& redesigns,
                                     const Progress& progress);

/// Results of all hands with one more product beside the original: what a search evaluates. Product
/// 0 is the original, 1 the candidate, whose records come without fields, and without indices
/// unless asked for.
StudyResults assess_candidate(const RedesignRequest& request, const HeldOriginal& original,
                              const Product& candidate, bool with_indices,
                              const Progress& progress);

}  // namespace palmar
