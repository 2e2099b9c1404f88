// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/dimension_table.h"

namespace palmar::workflow {

/// Whom and what a task takes of a table of subjects.
struct TableChoice {
  std::string file;  ///< CSV, one line per person, units in the headings (read_dimension_table())
  std::string unit = {};  ///< of dimensions whose heading names none: "mm", "cm" ...; "": an error
  std::vector<std::string> conditions = {};  ///< only subjects that meet all: "sex=F", "age>=40"
  std::string by = {};                    ///< column whose values group the subjects; "": one group
  std::vector<std::string> columns = {};  ///< by name; empty: every column of numbers
  void check() const;                     ///< throws UsageError: field, value, what is allowed
};

/// The groups of the subjects; what was found in the table is added to `notes`. Throws UsageError:
/// a condition or column that can't be; InputError naming file, line and column.
std::vector<population::TableGroup> load_groups(const TableChoice& choice,
                                                std::vector<std::string>& notes);

}  // namespace palmar::workflow
