// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/report/page/print_pdf.h"
#include "palmar/report/study/study_answer.h"
#include "palmar/report/study/study_report.h"
#include "palmar/study/statistics/study_comparison.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::workflow {

/// The page of a study.
struct StudyReportRequest {
  std::filesystem::path store;
  std::string folder;                 ///< for page, tables and figures; made if missing
  report::StudyReportOptions report;  ///< its threshold at most 100 MPa
  std::optional<report::Paper> pdf = std::nullopt;  ///< answer.pdf and report.pdf on this paper
  void check() const;  ///< throws UsageError: setting, value, what is allowed
};
/// Writes what write_study_report() says and gives back the path of the page. Throws as it does;
/// UsageError also if no grasp was run yet; InputError naming the store.
std::filesystem::path report_study(const StudyReportRequest& request,
                                   const Progress& progress = {});

/// Differences between the products of a study over the same hands.
struct StudyCompareRequest {
  std::filesystem::path store;
  /// Keys of results: "contact_area_mm2", an index's; "all" for everything that the study has.
  std::vector<std::string> quantities = {"peak_pressure_cells_mpa"};
  study::ComparisonOptions comparison;
  Language language = Language::kEnglish;
  void check() const;  ///< throws UsageError: field, value, what is allowed
};

/// Two products; the mean grip forces of the hands that hold both, where they are known.
struct ComparedPair {
  study::ProductPair pair;
  std::optional<study::GripForces> forces;
};
/// One quantity under one condition.
struct ComparedQuantity {
  study::StudyQuantity quantity;
  std::vector<study::ProductStatistics> products;  ///< of this quantity, by product
  std::vector<ComparedPair> pairs;                 ///< by first, then second
};
struct ComparedCondition {
  study::StudyCondition condition;
  std::vector<ComparedQuantity> quantities;
};
struct StudyCompareOutcome {
  study::StudyResults results;
  std::vector<ComparedCondition> conditions;  ///< as conditions_of()
  report::StudyAnswer answer;                 ///< as it stands in the report
};

/// The products of `results` compared by `quantities`, condition by condition.
StudyCompareOutcome compare_results(study::StudyResults results,
                                    const std::vector<study::StudyQuantity>& quantities,
                                    const report::StudyAnswerOptions& options = {});

/// Throws UsageError: an unknown quantity (with the nearest), no grasp was run yet; InputError.
StudyCompareOutcome compare_study(const StudyCompareRequest& request);

}  // namespace palmar::workflow
