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
/// Loads, draws and grasps; the place is that of the populations' mean hand. Throws as
/// RedesignRequest::check() and load_study(), NumericalError if no hand holds the product: no
/// answer; Cancelled.
HeldOriginal grasp_original(const RedesignRequest& request, const Progress& progress);

/// A redesigned product with what is to be said of it.
struct RedesignedProduct {
  Product product;
  std::string name;  ///< "pressed", "fillet 8 mm"
  std::string file;  ///< that was written
};

/// How differently the hands of a comparison hold the original and one redesign, over the hands
/// that hold both: where the same place of the product lies in the hand, and how it is turned
/// there.
struct HoldChange {
  std::string redesign;
  int hands = 0;
  double turn = 0.0, largest_turn = 0.0;    ///< median and largest, rad
  double shift = 0.0, largest_shift = 0.0;  ///< median and largest, mm
  /// The median is beyond 30 degrees or 10 mm: the redesign is held in another way, and a
  /// difference may be the hold's rather than the shape's.
  bool is_other_hold() const;
};

/// Original and redesigns in the same hands.
struct RedesignComparison {
  StudyResults results;                    ///< product 0 is the original; without fields
  std::vector<StudyQuantity> quantities;   ///< that are compared in words; the report has all
  std::filesystem::path report;            ///< report.html
  std::filesystem::path study;             ///< store of the study
  Language language = Language::kEnglish;  ///< of the report
  bool is_in_other_hands = false;          ///< than those that the redesign was made for
  std::vector<HoldChange> changes;         ///< one per redesign
  std::vector<std::string> notes;          ///< those two in sentences
};
/// The last step of every redesign: original and redesigns in the same hands, others of the same
/// populations than those of `original`; given hands (a table), which can't be drawn anew, are the
/// same. Redesigns are held as the original is: the same hold, the same grip force, or the posture
/// kept. Writes OUT/redesign.palmar and OUT/report/.
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
