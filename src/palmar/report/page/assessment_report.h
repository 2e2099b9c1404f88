// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/report/page/report_extras.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::report {

struct ReportOptions {
  Language language = Language::kEnglish;
  bool pictures = true;      ///< PNG pictures from four views
  int picture_width = 1000;  ///< pixels
  int picture_height = 700;  ///< pixels
  ReportExtras extras = {};  ///< whose it is, units, files for other programs
  void check() const;        ///< throws UsageError outside 64..8192 pixels
};

/// Throws UsageError naming the file if the folder holds a report.html, assessment.json or
/// regions.csv that Palmar didn't write: a report never overwrites somebody else's work. Throws
/// OutputError if the path is no folder. A folder that doesn't exist yet is fine.
void check_report_folder(const std::string& folder);

/// Writes a folder that a designer can open: report.html (one file, works offline),
/// assessment.json, regions.csv, and per product a sub-folder with fields (hand.vtp, product.vtp,
/// grasp.glb) and pictures (PNG). Every file is written under a temporary name and renamed.
///
/// The numbers come first, so they stand whatever happens later. When cancelled, the remaining
/// fields and pictures are left out, report.html is still written with what is there, and Cancelled
/// is thrown. Throws OutputError, and UsageError as check_report_folder().
void write_report(const std::string& folder, const study::AssessmentSet& set,
                  const ReportOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::report
