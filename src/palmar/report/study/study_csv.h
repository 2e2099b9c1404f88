// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/records/csv.h"
#include "palmar/study/statistics/study_analysis.h"

namespace palmar::report {

/// A table with the name of its file.
struct NamedTable {
  std::string name;  ///< "comparison.csv"
  records::CsvTable table;
  std::string about;  ///< what a row is, a sentence
};

/// The statistics of a study in full digits: statistics.csv (per condition, product and quantity),
/// comparison.csv (per pair), accommodation.csv, outcomes.csv (how grasps ended), holds.csv (by
/// which part and how each product is held), regions.csv,
/// size_dependence.csv, sizes.csv. Units stand in the headers or in a column beside the quantity.
std::vector<NamedTable> study_csv(const study::StudyResults& results,
                                  const study::StudyAnalysis& analysis);

/// Population, profile, setting and grip of a condition: what every table begins with.
std::vector<std::string> condition_cells(const study::StudyPlan& plan,
                                         const study::StudyCondition& one);

/// The comparison alone; only of one quantity if `key` isn't empty.
records::CsvTable comparison_csv(const study::StudyResults& results,
                                 const study::StudyAnalysis& analysis, const std::string& key = {});

}  // namespace palmar::report
