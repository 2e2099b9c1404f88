// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_describe.h"

#include <vector>

#include "palmar/workflow/population/table_analysis.h"

namespace palmar {

void TableDescribeRequest::check() const { table.check(); }

Descriptions describe_table(const TableDescribeRequest& request) {
  request.check();
  std::vector<TableGroup> groups;
  const auto results = analysed<std::vector<ColumnDescription>>(
      request.table, Descriptions{}.level, groups,
      [&](const DimensionTable& table) { return describe(table, request.table.columns); });
  if (results.groups.front().result.empty()) {
    throw InputError(request.table.file + " has no column of numbers to describe");
  }
  for (const std::string& text : results.notes) note_to(request.note, text);
  if (!request.out.empty()) write_table(request.out, "description.csv", descriptions_csv(results));
  return results;
}

}  // namespace palmar
