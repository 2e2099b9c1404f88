// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/records/table_results.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/population/table_choice.h"

namespace palmar::workflow {

/// Mean, deviation and percentiles of every dimension of a table of subjects.
struct TableDescribeRequest {
  TableChoice table;
  std::string out = {};  ///< folder that gets description.csv; "": nothing is written
  NoteSink note = {};    ///< what was found in the table
  void check() const;    ///< throws UsageError: field, value, what is allowed
};

/// Throws UsageError; InputError naming the file: unreadable, no column of numbers; OutputError.
records::Descriptions describe_table(const TableDescribeRequest& request);

}  // namespace palmar::workflow
