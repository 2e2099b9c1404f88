// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/assessment/assessment.h"

namespace palmar::report {

/// Whether friction holds the load, how much it could hold, how the product moves or slips (in
/// directions of the hand), in a few plain sentences; empty if friction is off.
std::string friction_verdict(const hand::Hand& hand, const study::Assessment& assessment);

}  // namespace palmar::report
