// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/validation/validation.h"

namespace palmar::records {

/// The report of `palmar validate`: one object with cases, their rows, and counts of verdicts.
/// `seconds` are the only values that change from run to run.
std::string validation_json(const validation::ValidationReport& report);

}  // namespace palmar::records
