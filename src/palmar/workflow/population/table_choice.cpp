// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_choice.h"

#include "palmar/records/population/dimension_table_file.h"

namespace palmar {

void TableChoice::check() const { TableReading{.unit = unit}.check(); }

std::vector<TableGroup> load_groups(const TableChoice& choice, std::vector<std::string>& notes) {
  DimensionTable table = read_dimension_table(choice.file, {.unit = choice.unit});
  for (const std::string& condition : choice.conditions) table = where(table, condition);
  notes = table.notes;
  return grouped(table, choice.by, notes);
}

}  // namespace palmar
