// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/population/population.h"
#include "palmar/records/table_results.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/population/table_choice.h"

namespace palmar::workflow {

/// Every dimension of a table of subjects on a few of them, and what the table says about the
/// people it was taken from.
struct TableRegressRequest {
  TableChoice table;
  std::vector<std::string> predictors = {};  ///< columns; empty: hand_length and
                                             ///< hand_circumference, as far as the table has them
  double level = 0.95;                       ///< of the bands in the charts
  std::string out = {};             ///< folder that gets regression.csv and charts; "": none
  std::string population_out = {};  ///< population file to write (TOML), driven by the predictors;
                                    ///< "": none
  std::string name = {};            ///< of the population; "": that of its file
  std::string title = {};  ///< of the population, for people; "": "People of " and its file
  NoteSink note = {};      ///< what was found in the table; the population's cautions
  void check() const;      ///< throws UsageError: field, value, what is allowed
};

struct TableRegressOutcome {
  records::Regressions regressions;
  std::optional<population::Population> population;  ///< that was written
};

/// Throws UsageError, also if nothing is left to regress and no population is asked for; InputError
/// naming file, line and column (a predictor that doesn't vary, too few subjects); OutputError.
TableRegressOutcome regress_table(const TableRegressRequest& request);

}  // namespace palmar::workflow
