// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/population/table_statistics.h"
#include "palmar/records/csv.h"

namespace palmar::records {

/// What was found in each group of a table of subjects.
template <typename Result>
struct TableResults {
  std::string source;
  std::string by;  ///< "": one group "all"
  double level = 0.95;
  std::vector<std::string> notes;
  struct Group {
    std::string name;
    int subjects = 0;
    Result result;
  };
  std::vector<Group> groups;
};
using Descriptions = TableResults<std::vector<population::ColumnDescription>>;
using Correlations = TableResults<population::TableCorrelation>;
using Regressions = TableResults<std::vector<population::TableRegression>>;

/// JSON of the command line: keys carry the units ("mean_mm"); docs/using/populations.md.
std::string descriptions_json(const Descriptions& descriptions);
std::string correlations_json(const Correlations& correlations);
std::string regressions_json(const Regressions& regressions);

/// The same as tables, one row per group and dimension, pair or regression.
CsvTable descriptions_csv(const Descriptions& descriptions);
CsvTable correlations_csv(const Correlations& correlations);
CsvTable regressions_csv(const Regressions& regressions);

/// A p value for people: "0.012", "1.5e-07", "< 1e-300".
std::string p_text(double p_value);

/// Holm's adjustment of Pearson's p values over the pairs of one group, in their order.
std::vector<double> adjusted_p_values(const population::TableCorrelation& correlation);

}  // namespace palmar::records
