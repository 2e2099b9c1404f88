// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/page/html_report.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar {

/// Two or more products side by side: pressure on the opened hand, the grasp from the palm's side,
/// the main numbers; for exactly two, the difference in every region as well. Empty for one
/// product. `pictures` as for html_report().
std::string comparison(const AssessmentSet& set,
                       const std::vector<std::vector<EncodedPicture>>& pictures);

}  // namespace palmar
