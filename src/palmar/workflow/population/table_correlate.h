// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/records/table_results.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/population/table_choice.h"

namespace palmar::workflow {

/// How the dimensions of a table of subjects go together: every pair of them.
struct TableCorrelateRequest {
  TableChoice table;
  double level = 0.95;   ///< of the confidence intervals
  std::string out = {};  ///< folder that gets correlation.csv and charts; "": nothing is written
  NoteSink note = {};    ///< what was found in the table and in each group
  void check() const;    ///< throws UsageError: field, value, what is allowed
};

/// Throws UsageError; InputError naming file, line and column (a column that doesn't vary, too few
/// subjects); OutputError.
records::Correlations correlate_table(const TableCorrelateRequest& request);

}  // namespace palmar::workflow
