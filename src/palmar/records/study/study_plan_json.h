// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/study/study_plan.h"

namespace palmar::records {

/// The plan as one JSON object, every number with the shortest digits that read back to the same
/// double: equal plans give equal text. Keys carry units.
std::string format_plan(const study::StudyPlan& plan);

/// What of the plan makes the study what it is: the same without the paths of products' files,
/// whose content is in it.
std::string format_identity(const study::StudyPlan& plan);

/// Reads it back. Throws InputError; `name` stands in front.
study::StudyPlan parse_plan(const std::string& text, const std::string& name);

/// What a plan has otherwise than another, for people, at most `most` lines: "product \"handle\":
/// size was 1, now 1.1". Empty for equal plans, wherever their products' files lie.
std::vector<std::string> plan_differences(const study::StudyPlan& before,
                                          const study::StudyPlan& now, std::size_t most = 5);

}  // namespace palmar::records
