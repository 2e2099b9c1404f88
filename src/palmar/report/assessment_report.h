// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/progress.h"
#include "palmar/study/assessment.h"

namespace palmar {

struct ReportOptions {
  bool pictures = true;      ///< PNG pictures from four views
  int picture_width = 1000;  ///< pixels
  int picture_height = 700;  ///< pixels
  void check() const;        ///< throws UsageError outside 64..8192 pixels
};

/// Writes a folder that a designer can open: report.html (one file, works offline),
/// assessment.json, and per product a sub-folder with fields (hand.vtp, product.vtp, grasp.glb) and
/// pictures (PNG). Every file is written under a temporary name and renamed. Throws OutputError,
/// Cancelled.
void write_report(const std::string& folder, const AssessmentSet& set,
                  const ReportOptions& options = {}, const Progress& progress = {});

}  // namespace palmar
