// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/validation/validation.h"

namespace palmar {

/// The report of `palmar validate`: one object with cases, their rows, and counts of verdicts.
/// `seconds` are the only values that change from run to run.
std::string validation_json(const ValidationReport& report);

}  // namespace palmar
