// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/report/chart/study_figures.h"
#include "palmar/report/page/report_extras.h"
#include "palmar/report/study/study_scene.h"
#include "palmar/study/statistics/study_comparison.h"

namespace palmar::report {

struct StudyReportOptions {
  Language language = Language::kEnglish;
  std::string command;  ///< of the redesign that the study is of; may be empty
  study::ComparisonOptions comparison;
  double threshold = grasp::kBloodFlowStop;  ///< MPa, of the maps of shares; blood-flow family
  int most_grasps = 160;                     ///< in the 3-D view; 0: none. Some 50 kB each
  bool pictures = true;                      ///< of the maps
  bool figure_files = true;                  ///< figures/*.svg, .png, .pdf
  int picture_width = 1000;                  ///< pixels
  int picture_height = 700;                  ///< pixels
  ReportExtras extras = {};                  ///< whose it is, units, files for other programs
  std::vector<StudyFigure> figures = {};     ///< more of them: of the search that found a redesign
  void check() const;                        ///< throws UsageError: field, value, allowed range
};

/// What a report is made of.
struct StudyReportInput {
  const study::StudyResults& results;
  const study::StudyInputs& inputs;
  study::RecordSource records;  ///< with fields
  std::string program;          ///< that ran the study
  std::string digest;           ///< of its results; "": not finished
};

/// Writes a study's report into a folder (made if missing): report.html (everything in one file, no
/// network), the tables of study_csv(), figures/*.svg, *.png, *.pdf, maps/PRODUCT_*.png. Same
/// results, same bytes. Throws UsageError: nothing was run yet, or the folder holds a report.html
/// that Palmar didn't write; OutputError; Cancelled.
void write_study_report(const std::string& folder, const StudyReportInput& input,
                        const StudyReportOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::report
