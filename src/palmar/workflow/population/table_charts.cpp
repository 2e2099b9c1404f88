// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/population/table_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "palmar/formats/file.h"
#include "palmar/report/chart/correlation_chart.h"
#include "palmar/report/chart/scatter_chart.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::workflow {
namespace {

constexpr int kLinePlaces = 60;        // at which the line and its bands are drawn
constexpr double kSignificant = 0.05;  // p value

void write_chart(const std::string& folder, const std::string& name, const report::Figure& figure) {
  const std::filesystem::path path(folder);
  formats::write_file(path / (name + ".svg"), report::to_svg(figure));
  formats::write_file(path / (name + ".png"), report::to_png(figure));
  formats::write_file(path / (name + ".pdf"), report::to_pdf(figure));
}

std::string label_of(const population::DimensionTable& table, const std::string& name) {
  const population::TableColumn& column = table.column(name);
  std::string label = name;
  std::replace(label.begin(), label.end(), '_', ' ');
  return column.unit.empty() ? label : label + ", " + column.unit;
}

report::ScatterSeries series_of(const population::TableGroup& group,
                                const population::TableRegression& r, double level) {
  report::ScatterSeries series;
  series.name = group.name;
  const auto [xs, ys] = statistics::complete_pairs(group.table.column(r.predictors[0]).values,
                                                   group.table.column(r.name).values);
  for (std::size_t i = 0; i < xs.size(); ++i) series.points.emplace_back(xs[i], ys[i]);
  const auto [low, high] = std::minmax_element(xs.begin(), xs.end());
  for (int i = 0; i <= kLinePlaces; ++i) {
    const double x = *low + (*high - *low) * i / kLinePlaces;
    const statistics::Band mean = statistics::confidence_band(r.fit, x, level);
    const statistics::Band single = statistics::prediction_band(r.fit, x, level);
    series.line.x.push_back(x);
    series.line.value.push_back(mean.value);
    series.line.low.push_back(mean.low);
    series.line.high.push_back(mean.high);
    series.line.outer_low.push_back(single.low);
    series.line.outer_high.push_back(single.high);
  }
  return series;
}

/// "men: y = 12.300 + 0.4000 x, n = 40, ...", the group's name only if there are groups.
std::string equation_note(const std::string& group, const statistics::LinearFit& fit) {
  const double slope = fit.slopes[0].estimate;
  const std::string p = records::p_text(fit.f_p_value);
  return fmt::format("{}y = {:.3f} {} {:.4f} x, n = {}, R² = {:.3f}, residual sd {:.2f}, p {}{}",
                     group.empty() ? "" : group + ": ", fit.intercept.estimate,
                     slope < 0.0 ? "-" : "+", std::abs(slope), fit.n, fit.r2, fit.residual_sd,
                     p.starts_with('<') ? "" : "= ", p);
}

/// One dimension on one predictor.
report::ScatterChart scatter_of(const population::TableRegression& wanted,
                                const std::vector<population::TableGroup>& groups,
                                const records::Regressions& results) {
  report::ScatterChart chart;
  const population::DimensionTable& table = groups.front().table;
  chart.x_label = label_of(table, wanted.predictors[0]);
  chart.y_label = label_of(table, wanted.name);
  chart.title = report::capitalised(chart.y_label.substr(0, chart.y_label.find(',')) + " on " +
                                    chart.x_label.substr(0, chart.x_label.find(',')));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const population::TableRegression& r : results.groups[g].result) {
      if (r.name != wanted.name || r.predictors != wanted.predictors) continue;
      report::ScatterSeries series = series_of(groups[g], r, results.level);
      series.colour = report::series_colour(g);
      chart.series.push_back(std::move(series));
      chart.notes.push_back(equation_note(results.by.empty() ? "" : groups[g].name, r.fit));
    }
  }
  chart.notes.push_back(fmt::format("Shaded: {:g} % of the mean; dashed: {:g} % of people.",
                                    100.0 * results.level, 100.0 * results.level));
  return chart;
}

}  // namespace

std::string file_part(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
    result += is_plain ? c : '_';
  }
  return result;
}

void write_correlation_charts(const std::string& folder, const records::Correlations& results) {
  for (const auto& group : results.groups) {
    const bool is_one_of_several = !results.by.empty();
    report::CorrelationChart chart;
    chart.title = "Correlations" + (is_one_of_several ? ", " + results.by + " " + group.name : "");
    chart.names = group.result.names;
    chart.r = group.result.r;
    chart.is_significant.setConstant(chart.r.rows(), chart.r.cols(), true);
    for (const auto& pair : group.result.pairs) {
      const bool is_significant = pair.pearson.p_value < kSignificant;
      chart.is_significant(pair.a, pair.b) = chart.is_significant(pair.b, pair.a) = is_significant;
    }
    write_chart(folder, "correlation" + (is_one_of_several ? "_" + file_part(group.name) : ""),
                report::correlation_chart(chart));
  }
}

void write_scatter_charts(const std::string& folder,
                          const std::vector<population::TableGroup>& groups,
                          const records::Regressions& results) {
  for (const population::TableRegression& one : results.groups.front().result) {
    if (one.predictors.size() != 1) continue;
    write_chart(folder, file_part(one.name + "_on_" + one.predictors[0]),
                report::scatter_chart(scatter_of(one, groups, results)));
  }
}

}  // namespace palmar::workflow
