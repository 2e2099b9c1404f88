// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palmar/study/statistics/study_comparison.h"

namespace palmar::cli {

// Products compared over the same hands: per condition, per quantity.

nlohmann::ordered_json comparison_object(const StudyResults& results,
                                         const std::vector<StudyQuantity>& quantities,
                                         const ComparisonOptions& options);
std::string comparison_text(const StudyResults& results,
                            const std::vector<StudyQuantity>& quantities,
                            const ComparisonOptions& options);

}  // namespace palmar::cli
