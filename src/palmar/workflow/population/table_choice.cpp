// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_choice.h"

#include "palmar/records/population/dimension_table_file.h"

namespace palmar::workflow {

void TableChoice::check() const { records::TableReading{.unit = unit}.check(); }

std::vector<population::TableGroup> load_groups(const TableChoice& choice,
                                                std::vector<std::string>& notes) {
  population::DimensionTable table =
      records::read_dimension_table(choice.file, {.unit = choice.unit});
  for (const std::string& condition : choice.conditions)
    table = population::where(table, condition);
  notes = table.notes;
  return population::grouped(table, choice.by, notes);
}

}  // namespace palmar::workflow
