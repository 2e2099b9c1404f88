// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "palmar/population/dimension_table.h"
#include "palmar/statistics/correlation.h"
#include "palmar/statistics/linear_fit.h"
#include "palmar/statistics/summary.h"

namespace palmar::population {

inline constexpr std::array<double, 7> kTablePercentiles{1, 5, 25, 50, 75, 95, 99};

/// One column over the subjects that have it.
struct ColumnDescription {
  std::string name, unit;
  int missing = 0;
  std::optional<statistics::Summary> summary;  ///< nothing: no subject has it
  std::array<double, kTablePercentiles.size()> percentiles{};
};
/// Of every measure of the table (or of those named). Throws UsageError on an unknown name.
std::vector<ColumnDescription> describe(const DimensionTable& table,
                                        const std::vector<std::string>& names = {});

/// Pearson's and Spearman's correlation of every pair of columns over the subjects that have both.
struct TableCorrelation {
  std::vector<std::string> names;
  struct Pair {
    int a = 0, b = 0;  ///< places in `names`, a < b
    statistics::Correlation pearson, spearman;
  };
  std::vector<Pair> pairs;
  Eigen::MatrixXd r;               ///< Pearson's; unit diagonal
  std::vector<std::string> notes;  ///< columns that are functions of one another
};
/// Throws InputError naming file, line and column: a column that doesn't vary, fewer than 3
/// subjects with both; UsageError: fewer than 2 columns.
TableCorrelation correlate(const DimensionTable& table, const std::vector<std::string>& names = {},
                           double level = 0.95);

/// One dimension on one or several predictors.
struct TableRegression {
  std::string name, unit;
  std::vector<std::string> predictors;
  statistics::LinearFit fit;
};
/// Every column of `names` (empty: every measure) that is no predictor, on each of `predictors` by
/// itself and, if there are several, on all of them together; in that order per column, over the
/// subjects that have the column and all predictors. Throws
/// InputError naming file, line and column: a predictor that doesn't vary or is a function of the
/// others (singular covariance), too few subjects.
std::vector<TableRegression> regress(const DimensionTable& table,
                                     const std::vector<std::string>& predictors,
                                     const std::vector<std::string>& names = {});

/// Which of the single predictors of one dimension explains most of it: the place in `regressions`,
/// -1 if there is none. All must be of the dimension `name`.
int best_predictor(const std::vector<TableRegression>& regressions, const std::string& name);

/// hand_length and hand_circumference as far as the table has them. Throws UsageError if neither.
std::vector<std::string> usual_predictors(const DimensionTable& table);

/// Columns (numbers) by name or all measures. Throws UsageError: unknown, or text.
std::vector<const TableColumn*> chosen_columns(const DimensionTable& table,
                                               const std::vector<std::string>& names);

}  // namespace palmar::population
