// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/records/assessment/verdict_text.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::records {

/// assessment.json: one object {"assessments": [{"product", "hand", "hold", "doubts", "grasp",
/// "contact", "verdict", "indices", "settings", "friction" (if it is on)}], "verdict",
/// "versions", ...}. Keys carry units (force_n, contact_area_mm2, peak_pressure_mpa, ..._mm,
/// ..._deg); doubles are printed shortest so that they read back exactly. The text depends on
/// command line, input and seed alone. `words`: verdict_words() of the set; without them verdicts
/// have figures only.
std::string assessment_json(const study::AssessmentSet& set, const VerdictWords& words = {});

/// Whether a file's content is an assessment.json that Palmar wrote.
bool is_assessment_json(const std::string& text);

/// One grasp: status, message, posture in degrees, placement, what stopped each segment.
std::string grasp_json(const grasp::Grasp& grasp);
/// The grasp and its runners-up as one list, best first: {"status", "message", "candidates",
/// "placements": [{"grip", "score", "posture", "product_from_hand"}]}.
std::string placements_json(const grasp::Grasp& grasp);

}  // namespace palmar::records
