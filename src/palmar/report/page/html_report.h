// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/picture/colour_bar.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar {

/// A picture as the report embeds it.
struct EncodedPicture {
  std::string name;   ///< as in Picture
  std::string title;  ///< caption
  std::string alt;    ///< for those who can't see it
  std::string png;    ///< bytes
};

/// The whole report as one HTML document that needs no other file and no network (its content
/// policy forbids both): summary, and per product verdicts, tables, pictures and a turnable 3-D
/// view; then method limits, provenance and licences; assessment.json stands inside, too.
///
/// `pictures[i]` belongs to set.assessments[i] and may be empty. `json` is assessment_json(set).
/// `is_cut_short`: some pictures are missing because the user cancelled, and the report says so.
/// Throws UsageError if the counts differ or set.hand is missing.
std::string html_report(const AssessmentSet& set,
                        const std::vector<std::vector<EncodedPicture>>& pictures,
                        const ColourScale& scale, const std::string& json,
                        bool is_cut_short = false);

}  // namespace palmar
