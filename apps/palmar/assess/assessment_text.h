// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"
#include "palmar/records/assessment/verdict_text.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::cli {

// `palmar assess` on the terminal.

/// The answer, why, and what to do next.
std::string verdict_text(const records::VerdictWords& words);

/// One product in a few lines: hold, grip force, rest, area, pressure, and what is doubtful.
std::string summary_text(const hand::Hand& hand, const study::AssessedProduct& one);

/// Everything: also every region, joint and index.
std::string details_text(const hand::Hand& hand, const study::AssessedProduct& one);

}  // namespace palmar::cli
