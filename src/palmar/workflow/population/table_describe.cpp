// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_describe.h"

#include <vector>

#include "palmar/workflow/population/table_analysis.h"

namespace palmar::workflow {

void TableDescribeRequest::check() const { table.check(); }

records::Descriptions describe_table(const TableDescribeRequest& request) {
  request.check();
  std::vector<population::TableGroup> groups;
  const auto results = analysed<std::vector<population::ColumnDescription>>(
      request.table, records::Descriptions{}.level, groups,
      [&](const population::DimensionTable& table) {
        return population::describe(table, request.table.columns);
      });
  if (results.groups.front().result.empty()) {
    throw InputError(request.table.file + " has no column of numbers to describe");
  }
  for (const std::string& text : results.notes) note_to(request.note, text);
  if (!request.out.empty())
    write_table(request.out, "description.csv", records::descriptions_csv(results));
  return results;
}

}  // namespace palmar::workflow
