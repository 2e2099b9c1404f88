// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_regress.h"

#include <filesystem>

#include "palmar/population/table_population.h"
#include "palmar/records/population/population_file.h"
#include "palmar/statistics/distributions.h"
#include "palmar/workflow/population/table_analysis.h"
#include "palmar/workflow/population/table_charts.h"

namespace palmar::workflow {
namespace {

/// Columns of numbers that are no dimension of a hand: the population file can't hold them.
void note_what_is_left_out(const population::DimensionTable& table, const std::string& path,
                           const NoteSink& note) {
  std::string headers;
  for (const population::TableColumn* column : table.measures()) {
    if (!column->dimension) headers += (headers.empty() ? "" : ", ") + column->header;
  }
  if (headers.empty()) return;
  note_to(note, path + " is without " + headers + ": no dimension of a hand that Palmar has");
}

population::Population written_population(const TableRegressRequest& request,
                                          const std::vector<population::TableGroup>& groups,
                                          const std::vector<std::string>& predictors) {
  const std::string& path = request.population_out;
  const std::string stem = std::filesystem::path(path).stem().string();
  const population::Population population = population::population_of_table(
      groups, predictors, request.name.empty() ? file_part(stem) : request.name,
      request.title.empty() ? "People of " + stem : request.title);
  records::write_population(path, population);
  for (const std::string& text : population.cautions) note_to(request.note, text);
  note_what_is_left_out(groups.front().table, path, request.note);
  return population;
}

}  // namespace

void TableRegressRequest::check() const {
  table.check();
  statistics::check_level(level);
}

TableRegressOutcome regress_table(const TableRegressRequest& request) {
  request.check();
  std::vector<population::TableGroup> groups;
  std::vector<std::string> predictors = request.predictors;
  TableRegressOutcome outcome;
  outcome.regressions = analysed<std::vector<population::TableRegression>>(
      request.table, request.level, groups, [&](const population::DimensionTable& table) {
        if (predictors.empty()) predictors = population::usual_predictors(table);
        return population::regress(table, predictors, request.table.columns);
      });
  const records::Regressions& results = outcome.regressions;
  for (const std::string& text : results.notes) note_to(request.note, text);
  if (results.groups.front().result.empty() && request.population_out.empty()) {
    throw UsageError(request.table.file + " has no column beside the predictors to regress");
  }
  if (!request.out.empty()) {
    write_table(request.out, "regression.csv", records::regressions_csv(results));
    write_scatter_charts(request.out, groups, results);
  }
  if (!request.population_out.empty()) {
    outcome.population = written_population(request, groups, predictors);
  }
  return outcome;
}

}  // namespace palmar::workflow
