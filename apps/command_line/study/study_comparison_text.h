// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "palmar/workflow/study/study_report.h"

namespace palmar::cli {

// Products compared over the same hands: per condition, per quantity.

nlohmann::ordered_json comparison_object(const workflow::StudyCompareOutcome& outcome,
                                         const study::ComparisonOptions& options);
/// The answer, why, and what to do next.
std::string answer_text(const report::StudyAnswer& answer);
std::string comparison_text(const workflow::StudyCompareOutcome& outcome);

}  // namespace palmar::cli
