// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/page/report_extras.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::report {

struct AssessmentPageOptions {
  Language language = Language::kEnglish;
  bool is_cut_short = false;  ///< pictures are missing as the user cancelled; the report says so
  ReportExtras extras = {};
};

/// The whole report as one HTML document that needs no other file and no network (its content
/// policy forbids both): summary, and per product verdicts, tables, pictures and a turnable 3-D
/// view; then method limits, provenance and licences; assessment.json stands inside, too.
///
/// `pictures[i]` belongs to set.assessments[i] and may be empty. `json` is assessment_json(set).
/// Throws UsageError if the counts differ, or the set has no hand or no assessment.
std::string assessment_page(const study::AssessmentSet& set,
                            const std::vector<std::vector<EncodedPicture>>& pictures,
                            const ColourScale& scale, const std::string& json,
                            const AssessmentPageOptions& options = {});

}  // namespace palmar::report
