// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/table_statistics.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar::population {
namespace {

// Share of a column's variance that others leave unexplained; below it the covariance is singular
// as far as measured sizes go.
constexpr double kSingular = 1e-9;

std::vector<double> present(const TableColumn& column) {
  std::vector<double> values;
  for (const auto& value : column.values) {
    if (value) values.push_back(*value);
  }
  return values;
}

int first_line(const DimensionTable& table) { return table.lines.empty() ? 0 : table.lines[0]; }

void check_varies(const DimensionTable& table, const TableColumn& column,
                  const std::vector<double>& values) {
  if (values.size() < 3) {
    table.fail(first_line(table), column,
               std::to_string(values.size()) +
                   (values.size() == 1 ? " subject has it" : " subjects have it") +
                   "; at least 3 are needed");
  }
  if (statistics::is_constant(values)) {
    table.fail(first_line(table), column,
               "all " + std::to_string(values.size()) + " values are " + significant(values[0], 6) +
                   (column.unit.empty() ? "" : " " + column.unit) +
                   "; values that vary are needed");
  }
}

constexpr std::size_t kMostNamed = 8;

std::string headers_of(const std::vector<const TableColumn*>& columns) {
  std::string text;
  for (std::size_t i = 0; i < std::min(columns.size(), kMostNamed); ++i) {
    text += (text.empty() ? "" : ", ") + std::to_string(columns[i]->number) + " (" +
            columns[i]->header + ")";
  }
  if (columns.size() > kMostNamed) {
    text += " and " + std::to_string(columns.size() - kMostNamed) + " more";
  }
  return text;
}

/// Columns that make a correlation matrix singular: those in its null direction.
std::vector<const TableColumn*> dependent_columns(const Eigen::MatrixXd& r,
                                                  const std::vector<const TableColumn*>& columns) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(r);
  std::vector<const TableColumn*> dependent;
  if (std::abs(eigen.eigenvalues()[0]) > kSingular) return dependent;
  const Eigen::VectorXd direction = eigen.eigenvectors().col(0).cwiseAbs();
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (direction[i] > 1e-3) dependent.push_back(columns[i]);
  }
  return dependent;
}

/// Rows in which every column has a value, as a matrix.
Eigen::MatrixXd complete_rows(const std::vector<const TableColumn*>& columns) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < columns[0]->values.size(); ++row) {
    const bool is_whole = std::all_of(columns.begin(), columns.end(), [&](const TableColumn* c) {
      return c->values[row].has_value();
    });
    if (is_whole) rows.push_back(row);
  }
  Eigen::MatrixXd values(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          *columns[k]->values[rows[i]];
    }
  }
  return values;
}

std::span<const double> column_of(const Eigen::MatrixXd& values, Eigen::Index k) {
  return {values.col(k).data(), static_cast<std::size_t>(values.rows())};
}

void check_independent(const DimensionTable& table, const Eigen::MatrixXd& values,
                       const std::vector<const TableColumn*>& predictors) {
  const auto k = static_cast<Eigen::Index>(predictors.size());
  Eigen::MatrixXd r = Eigen::MatrixXd::Identity(k, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    for (Eigen::Index j = i + 1; j < k; ++j) {
      r(i, j) = r(j, i) = statistics::pearson(column_of(values, i), column_of(values, j)).r;
    }
  }
  const auto dependent = dependent_columns(r, predictors);
  if (!dependent.empty()) {
    table.fail(0, *dependent.back(),
               "the covariance is singular: columns " + headers_of(dependent) +
                   " are linear functions of one another; leave one out");
  }
}

}  // namespace

std::vector<const TableColumn*> chosen_columns(const DimensionTable& table,
                                               const std::vector<std::string>& names) {
  if (names.empty()) return table.measures();
  std::vector<const TableColumn*> columns;
  for (const std::string& name : names) {
    const TableColumn& column = table.column(name);
    if (!column.is_number) {
      throw UsageError(table.source + ": column \"" + column.header +
                       "\" holds text; numbers are needed");
    }
    if (std::find(columns.begin(), columns.end(), &column) == columns.end()) {
      columns.push_back(&column);
    }
  }
  return columns;
}

std::vector<ColumnDescription> describe(const DimensionTable& table,
                                        const std::vector<std::string>& names) {
  std::vector<ColumnDescription> result;
  for (const TableColumn* column : chosen_columns(table, names)) {
    std::vector<double> values = present(*column);
    ColumnDescription d;
    d.name = column->name;
    d.unit = column->unit;
    d.missing = table.subjects() - static_cast<int>(values.size());
    if (!values.empty()) {
      d.summary = statistics::summarise(values);
      std::sort(values.begin(), values.end());
      for (std::size_t i = 0; i < kTablePercentiles.size(); ++i) {
        d.percentiles[i] = statistics::quantile(values, kTablePercentiles[i] / 100.0);
      }
    }
    result.push_back(std::move(d));
  }
  return result;
}

TableCorrelation correlate(const DimensionTable& table, const std::vector<std::string>& names,
                           double level) {
  TableCorrelation result;
  std::vector<const TableColumn*> columns = chosen_columns(table, names);
  if (names.empty()) {
    // A column that nobody filled in says nothing; who asks for it by name is reported so below.
    const auto is_empty = [&](const TableColumn* column) {
      if (!present(*column).empty()) return false;
      result.notes.push_back(table.source + ": column " + std::to_string(column->number) + " (" +
                             column->header + ") has no values and is left out");
      return true;
    };
    columns.erase(std::remove_if(columns.begin(), columns.end(), is_empty), columns.end());
  }
  if (columns.size() < 2) {
    throw UsageError(table.source + ": " + std::to_string(columns.size()) +
                     " columns of numbers to correlate; at least 2 are needed");
  }
  for (const TableColumn* column : columns) {
    check_varies(table, *column, present(*column));
    result.names.push_back(column->name);
  }
  const auto k = static_cast<Eigen::Index>(columns.size());
  result.r = Eigen::MatrixXd::Identity(k, k);
  for (Eigen::Index a = 0; a < k; ++a) {
    for (Eigen::Index b = a + 1; b < k; ++b) {
      const TableColumn& x = *columns[a];
      const TableColumn& y = *columns[b];
      const auto [xs, ys] = statistics::complete_pairs(x.values, y.values);
      if (xs.size() < 3) {
        table.fail(first_line(table), y,
                   std::to_string(xs.size()) + " subjects have it together with column " +
                       std::to_string(x.number) + " (" + x.header + "); at least 3 are needed");
      }
      const TableCorrelation::Pair pair{static_cast<int>(a), static_cast<int>(b),
                                        statistics::pearson(xs, ys, level),
                                        statistics::spearman(xs, ys)};
      result.r(a, b) = result.r(b, a) = pair.pearson.r;
      result.pairs.push_back(pair);
    }
  }
  const auto dependent = dependent_columns(result.r, columns);
  if (table.subjects() <= static_cast<int>(columns.size())) {
    result.notes.push_back(table.source + ": " + std::to_string(table.subjects()) +
                           " subjects for " + std::to_string(columns.size()) +
                           " columns: the covariance is singular; more subjects than columns are "
                           "needed to draw from it");
  } else if (!dependent.empty()) {
    result.notes.push_back(table.source + ":" + std::to_string(table.header_line) +
                           ": the covariance is singular: columns " + headers_of(dependent) +
                           " are linear functions of one another");
  } else if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(result.r).eigenvalues()[0] < 0.0) {
    result.notes.push_back(table.source +
                           ": with values missing, pairs are of different subjects, and their "
                           "correlations contradict one another (not positive definite)");
  }
  return result;
}

std::vector<TableRegression> regress(const DimensionTable& table,
                                     const std::vector<std::string>& predictor_names,
                                     const std::vector<std::string>& names) {
  if (predictor_names.empty()) throw UsageError("regression without a predictor");
  const std::vector<const TableColumn*> predictors = chosen_columns(table, predictor_names);
  if (predictors.size() < predictor_names.size()) {
    throw UsageError("a predictor is named twice; each of " + joined(predictor_names, ", ") +
                     " has to be another column");
  }
  for (const TableColumn* p : predictors) check_varies(table, *p, present(*p));
  check_independent(table, complete_rows(predictors), predictors);
  std::vector<std::vector<const TableColumn*>> sets;
  for (const TableColumn* p : predictors) sets.push_back({p});
  if (predictors.size() > 1) sets.push_back(predictors);

  std::vector<TableRegression> result;
  for (const TableColumn* y : chosen_columns(table, names)) {
    if (std::find(predictors.begin(), predictors.end(), y) != predictors.end()) continue;
    if (names.empty() && present(*y).empty()) continue;  // nobody filled it in
    check_varies(table, *y, present(*y));
    // The same people for every set of predictors, so that R2 can be compared.
    std::vector<const TableColumn*> all = predictors;
    all.push_back(y);
    const Eigen::MatrixXd values = complete_rows(all);
    const auto count = static_cast<Eigen::Index>(predictors.size());
    if (values.rows() < count + 2) {
      table.fail(first_line(table), *y,
                 std::to_string(values.rows()) + " subjects have it together with columns " +
                     headers_of(predictors) + "; at least " + std::to_string(count + 2) +
                     " are needed");
    }
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto x = column_of(values, j);
      check_varies(table, *predictors[j], {x.begin(), x.end()});
    }
    check_independent(table, values.leftCols(count), predictors);
    for (const auto& set : sets) {
      const auto k = static_cast<Eigen::Index>(set.size());
      const auto first = std::find(predictors.begin(), predictors.end(), set[0]);
      const Eigen::MatrixXd x = values.middleCols(first - predictors.begin(), k);
      TableRegression regression{y->name, y->unit, {}, {}};
      for (const TableColumn* p : set) regression.predictors.push_back(p->name);
      regression.fit = statistics::fit_linear(x, column_of(values, count), regression.predictors);
      result.push_back(std::move(regression));
    }
  }
  return result;
}

int best_predictor(const std::vector<TableRegression>& regressions, const std::string& name) {
  int best = -1;
  for (std::size_t i = 0; i < regressions.size(); ++i) {
    const TableRegression& r = regressions[i];
    if (r.name != name || r.predictors.size() != 1) continue;
    if (best < 0 || r.fit.r2 > regressions[best].fit.r2) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

std::vector<std::string> usual_predictors(const DimensionTable& table) {
  std::vector<std::string> names;
  for (const char* name : {"hand_length", "hand_circumference"}) {
    for (const TableColumn& c : table.columns) {
      if (c.name == name) names.push_back(c.name);
    }
  }
  if (names.empty()) {
    throw UsageError(table.source +
                     " has neither hand_length nor hand_circumference; name the predictors by "
                     "setting \"predictors\"");
  }
  return names;
}

}  // namespace palmar::population
