// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/progress.h"
#include "palmar/validation/validation.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

/// The simulator against closed forms and measurements.
struct ValidateRequest {
  validation::ValidationOptions options;
  HandChoice hand;
  std::string out;     ///< file to write, .md or .json; "": none
  NoteSink note = {};  ///< when something takes long
  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

/// Runs the cases and writes the table. Misses are rows of the report. Throws UsageError,
/// InputError, OutputError, Cancelled.
validation::ValidationReport run_validation(const ValidateRequest& request,
                                            const Progress& progress = {});

}  // namespace palmar::workflow
