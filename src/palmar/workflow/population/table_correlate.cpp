// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_correlate.h"

#include <vector>

#include "palmar/statistics/distributions.h"
#include "palmar/workflow/population/table_analysis.h"
#include "palmar/workflow/population/table_charts.h"

namespace palmar::workflow {

void TableCorrelateRequest::check() const {
  table.check();
  statistics::check_level(level);
}

records::Correlations correlate_table(const TableCorrelateRequest& request) {
  request.check();
  std::vector<population::TableGroup> groups;
  const auto results = analysed<population::TableCorrelation>(
      request.table, request.level, groups, [&](const auto& table) {
        return population::correlate(table, request.table.columns, request.level);
      });
  for (const std::string& text : results.notes) note_to(request.note, text);
  for (const auto& group : results.groups) {
    for (const std::string& text : group.result.notes) note_to(request.note, text);
  }
  if (request.out.empty()) return results;
  write_table(request.out, "correlation.csv", records::correlations_csv(results));
  write_correlation_charts(request.out, results);
  return results;
}

}  // namespace palmar::workflow
