// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/assessment/assessment.h"

namespace palmar {

/// How the grasp came to rest, in plain sentences, for the HTML report. Without a balance: what the
/// forces add up to as they are.
std::string balance_section(const Assessment& assessment);

}  // namespace palmar
