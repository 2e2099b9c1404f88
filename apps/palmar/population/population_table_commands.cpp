// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "population/population_table_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/population/table_population.h"
#include "palmar/records/csv.h"
#include "palmar/records/population/dimension_table_file.h"
#include "palmar/records/population/population_file.h"
#include "palmar/records/table_results.h"
#include "palmar/report/chart/correlation_chart.h"
#include "palmar/report/chart/scatter_chart.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/statistics/distributions.h"
#include "table_text.h"

namespace palmar::cli {
namespace {

constexpr int kLinePlaces = 60;  // at which the line and its bands are drawn

std::vector<std::string> names_in(const std::string& option, const std::string& list) {
  std::vector<std::string> names;
  for (std::size_t start = 0; !list.empty() && start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    names.push_back(list.substr(start, end - start));
    if (names.back().empty()) throw UsageError(option + ": \"" + list + "\" has an empty name");
    start = end + 1;
  }
  return names;
}

/// What the three verbs share: the table, who of it, what of it.
struct TableArguments {
  std::string file, by, unit, dimensions, out;
  std::vector<std::string> conditions;
  double level = 0.95;

  void add_to(CLI::App& verb) {
    verb.add_option("FILE", file, "Table of subjects: CSV, one line per person, units in headings")
        ->required();
    verb.add_option("--by", by,
                    "Column whose values group the subjects: sex, age (by ten years) ...");
    verb.add_option("--where", conditions,
                    "Only subjects that meet it: sex=F, \"age>=40\"; may be given several times");
    verb.add_option("--dimension", dimensions, "Only these columns: A,B,...");
    verb.add_option("--unit", unit,
                    "Unit of hand dimensions whose heading names none: mm, cm, m, in");
    verb.add_option("--out", out, "Folder for tables (CSV) and pictures (SVG, PNG, PDF)");
  }

  void add_level_to(CLI::App& verb) {
    verb.add_option("--level", level, "Confidence level")->capture_default_str();
  }

  std::vector<std::string> columns() const { return names_in("--dimension", dimensions); }

  std::vector<TableGroup> groups(std::vector<std::string>& notes) const {
    DimensionTable table = read_dimension_table(file, {.unit = unit});
    for (const std::string& condition : conditions) table = where(table, condition);
    notes = table.notes;
    return grouped(table, by, notes);
  }

  std::string path(const std::string& name) const {
    return (std::filesystem::path(out) / name).string();
  }

  void write_csv(const std::string& name, const CsvTable& table) const {
    if (out.empty()) return;
    create_folder(out);
    write_file(path(name), format_csv(table));
  }

  void write_figure(const std::string& name, const Figure& figure) const {
    write_file(path(name + ".svg"), to_svg(figure));
    write_file(path(name + ".png"), to_png(figure));
    write_file(path(name + ".pdf"), to_pdf(figure));
  }
};

/// The analysis of every group; what it says about a group of too few names the group.
template <typename Result, typename Analyse>
TableResults<Result> analysed(const TableArguments& arguments, std::vector<TableGroup>& groups,
                              const Analyse& analyse) {
  TableResults<Result> results;
  results.source = arguments.file;
  results.by = arguments.by;
  results.level = arguments.level;
  groups = arguments.groups(results.notes);
  for (const TableGroup& group : groups) {
    try {
      results.groups.push_back({group.name, group.table.subjects(), analyse(group.table)});
    } catch (const InputError& error) {
      if (arguments.by.empty()) throw;
      throw InputError(std::string(error.what()) + " (" + arguments.by + " " + group.name + ")");
    }
  }
  return results;
}

void report_notes(const Context& context, const std::vector<std::string>& notes) {
  for (const std::string& text : notes) note(context.common, text);
}

/// Columns of numbers that are no dimension of a hand: the population file can't hold them.
void report_what_is_left_out(const Context& context, const DimensionTable& table,
                             const std::string& path) {
  std::string headers;
  for (const TableColumn* column : table.measures()) {
    if (!column->dimension) headers += (headers.empty() ? "" : ", ") + column->header;
  }
  if (headers.empty()) return;
  note(context.common,
       path + " is without " + headers + ": no dimension of a hand that Palmar has");
}

/// A name of a file from that of a group: letters and digits stay.
std::string file_part(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
    result += is_plain ? c : '_';
  }
  return result;
}

void add_describe(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<TableArguments>();
  CLI::App* verb =
      add_verb(noun, "describe", "Mean, deviation and percentiles of every dimension of a table",
               "palmar population describe hands.csv --by sex");
  o->add_to(*verb);
  verb->callback([&context, o] {
    context.run = [&context, o] {
      std::vector<TableGroup> groups;
      const auto results = analysed<std::vector<ColumnDescription>>(
          *o, groups, [&](const DimensionTable& table) { return describe(table, o->columns()); });
      if (results.groups.front().result.empty()) {
        throw InputError(o->file + " has no column of numbers to describe");
      }
      report_notes(context, results.notes);
      o->write_csv("description.csv", descriptions_csv(results));
      print(context.common.json ? descriptions_json(results) + "\n" : descriptions_text(results));
      return 0;
    };
  });
}

void write_correlation_charts(const TableArguments& o, const Correlations& results) {
  for (const auto& group : results.groups) {
    CorrelationChart chart;
    chart.title = "Correlations" + (o.by.empty() ? "" : ", " + o.by + " " + group.name);
    chart.names = group.result.names;
    chart.r = group.result.r;
    chart.is_significant.setConstant(chart.r.rows(), chart.r.cols(), true);
    for (const auto& pair : group.result.pairs) {
      const bool is_significant = pair.pearson.p_value < 0.05;
      chart.is_significant(pair.a, pair.b) = chart.is_significant(pair.b, pair.a) = is_significant;
    }
    o.write_figure("correlation" + (o.by.empty() ? "" : "_" + file_part(group.name)),
                   correlation_chart(chart));
  }
}

void add_correlate(CLI::App& noun, Context& context) {
  const auto o = std::make_shared<TableArguments>();
  CLI::App* verb =
      add_verb(noun, "correlate",
               "Correlations between the dimensions of a table: r, interval, significance",
               "palmar population correlate hands.csv --by sex --out figures");
  o->add_to(*verb);
  o->add_level_to(*verb);
  verb->callback([&context, o] {
    context.run = [&context, o] {
      std::vector<TableGroup> groups;
      const auto results = analysed<TableCorrelation>(*o, groups, [&](const DimensionTable& table) {
        return correlate(table, o->columns(), o->level);
      });
      report_notes(context, results.notes);
      for (const auto& group : results.groups) report_notes(context, group.result.notes);
      if (!o->out.empty()) {
        o->write_csv("correlation.csv", correlations_csv(results));
        write_correlation_charts(*o, results);
      }
      print(context.common.json ? correlations_json(results) + "\n" : correlations_text(results));
      return 0;
    };
  });
}

std::string label_of(const DimensionTable& table, const std::string& name) {
  const TableColumn& column = table.column(name);
  std::string label = name;
  std::replace(label.begin(), label.end(), '_', ' ');
  return column.unit.empty() ? label : label + ", " + column.unit;
}

ScatterSeries series_of(const TableGroup& group, const TableRegression& r, double level) {
  ScatterSeries series;
  series.name = group.name;
  const auto [xs, ys] =
      complete_pairs(group.table.column(r.predictors[0]).values, group.table.column(r.name).values);
  for (std::size_t i = 0; i < xs.size(); ++i) series.points.emplace_back(xs[i], ys[i]);
  const auto [low, high] = std::minmax_element(xs.begin(), xs.end());
  for (int i = 0; i <= kLinePlaces; ++i) {
    const double x = *low + (*high - *low) * i / kLinePlaces;
    const Band mean = confidence_band(r.fit, x, level);
    const Band single = prediction_band(r.fit, x, level);
    series.line.x.push_back(x);
    series.line.value.push_back(mean.value);
    series.line.low.push_back(mean.low);
    series.line.high.push_back(mean.high);
    series.line.outer_low.push_back(single.low);
    series.line.outer_high.push_back(single.high);
  }
  return series;
}

/// One chart per dimension and predictor, groups in one chart.
void write_scatter_charts(const TableArguments& o, const std::vector<TableGroup>& groups,
                          const Regressions& results) {
  for (const TableRegression& first : results.groups.front().result) {
    if (first.predictors.size() != 1) continue;
    ScatterChart chart;
    const DimensionTable& table = groups.front().table;
    chart.x_label = label_of(table, first.predictors[0]);
    chart.y_label = label_of(table, first.name);
    chart.title = chart.y_label.substr(0, chart.y_label.find(',')) + " on " +
                  chart.x_label.substr(0, chart.x_label.find(','));
    chart.title = capitalised(chart.title);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (const TableRegression& r : results.groups[g].result) {
        if (r.name != first.name || r.predictors != first.predictors) continue;
        ScatterSeries series = series_of(groups[g], r, o.level);
        series.colour = series_colour(g);
        chart.series.push_back(std::move(series));
        chart.notes.push_back(
            fmt::format("{}y = {:.3f} {} {:.4f} x, n = {}, R² = {:.3f}, residual sd {:.2f}, p {}{}",
                        o.by.empty() ? "" : groups[g].name + ": ", r.fit.intercept.estimate,
                        r.fit.slopes[0].estimate < 0.0 ? "-" : "+",
                        std::abs(r.fit.slopes[0].estimate), r.fit.n, r.fit.r2, r.fit.residual_sd,
                        r.fit.f_p_value < 1e-300 ? "" : "= ", p_text(r.fit.f_p_value)));
      }
    }
    chart.notes.push_back(fmt::format("Shaded: {:g} % of the mean; dashed: {:g} % of people.",
                                      100.0 * o.level, 100.0 * o.level));
    o.write_figure(file_part(first.name + "_on_" + first.predictors[0]), scatter_chart(chart));
  }
}

void add_regress(CLI::App& noun, Context& context) {
  struct Options {
    TableArguments table;
    std::string on, population_out, name, title;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(noun, "regress",
               "Every dimension on hand length and circumference; a population file for studies",
               "palmar population regress hands.csv --by sex --population-out our_people.toml");
  o->table.add_to(*verb);
  o->table.add_level_to(*verb);
  verb->add_option("--on", o->on,
                   "Predictors A,B,...; default: hand_length and hand_circumference");
  verb->add_option("--population-out", o->population_out,
                   "Population file (TOML) to write, driven by the predictors");
  verb->add_option("--name", o->name, "Name of the population; default: that of its file");
  verb->add_option("--title", o->title, "Title of the population, for people");
  verb->callback([&context, o] {
    context.run = [&context, o] {
      std::vector<TableGroup> groups;
      check_level(o->table.level);
      std::vector<std::string> predictors = names_in("--on", o->on);
      const auto results = analysed<std::vector<TableRegression>>(
          o->table, groups, [&](const DimensionTable& table) {
            if (predictors.empty()) predictors = usual_predictors(table);
            return regress(table, predictors, o->table.columns());
          });
      report_notes(context, results.notes);
      if (results.groups.front().result.empty() && o->population_out.empty()) {
        throw UsageError(o->table.file + " has no column beside the predictors to regress");
      }
      if (!o->table.out.empty()) {
        o->table.write_csv("regression.csv", regressions_csv(results));
        write_scatter_charts(o->table, groups, results);
      }
      if (!o->population_out.empty()) {
        const std::string stem = std::filesystem::path(o->population_out).stem().string();
        const std::string name = o->name.empty() ? file_part(stem) : o->name;
        const Population population = population_of_table(
            groups, predictors, name, o->title.empty() ? "People of " + stem : o->title);
        write_population(o->population_out, population);
        report_notes(context, population.cautions);
        report_what_is_left_out(context, groups.front().table, o->population_out);
        note(context.common, "wrote " + o->population_out);
      }
      print(context.common.json ? regressions_json(results) + "\n" : regressions_text(results));
      return 0;
    };
  });
}

}  // namespace

void add_population_table_verbs(CLI::App& population, Context& context) {
  add_describe(population, context);
  add_correlate(population, context);
  add_regress(population, context);
}

}  // namespace palmar::cli
