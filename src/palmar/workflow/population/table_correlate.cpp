// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_correlate.h"

#include <vector>

#include "palmar/statistics/distributions.h"
#include "palmar/workflow/population/table_analysis.h"
#include "palmar/workflow/population/table_charts.h"

namespace palmar {

void TableCorrelateRequest::check() const {
  table.check();
  check_level(level);
}

Correlations correlate_table(const TableCorrelateRequest& request) {
  request.check();
  std::vector<TableGroup> groups;
  const auto results = analysed<TableCorrelation>(
      request.table, request.level, groups,
      [&](const auto& table) { return correlate(table, request.table.columns, request.level); });
  for (const std::string& text : results.notes) note_to(request.note, text);
  for (const auto& group : results.groups) {
    for (const std::string& text : group.result.notes) note_to(request.note, text);
  }
  if (request.out.empty()) return results;
  write_table(request.out, "correlation.csv", correlations_csv(results));
  write_correlation_charts(request.out, results);
  return results;
}

}  // namespace palmar
