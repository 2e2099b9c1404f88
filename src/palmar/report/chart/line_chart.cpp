// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/line_chart.h"

#include <algorithm>

#include "palmar/report/chart/figure.h"
#include "palmar/report/picture/colour_bar.h"

namespace palmar::report {
namespace {

constexpr double kAxesWidth = 560.0;
constexpr double kHeight = 320.0;
constexpr double kAxesLeft = 78.0;  // labels of y
constexpr double kAxesRight = 20.0;
constexpr double kAxesTop = 34.0;  // title
constexpr double kBottom = 52.0;
constexpr double kAxesLetters = 13.0;

std::vector<Eigen::Vector2d> drawn(const LineSeries& series) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& p : series.points) {
    if (p.allFinite()) points.push_back(p);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.x() < b.x(); });
  return points;
}

void add_series(Figure& figure, const LineSeries& series,
                const std::vector<Eigen::Vector2d>& places) {
  figure.polyline(places, {.colour = series.colour, .width = 2.0});
  for (const Eigen::Vector2d& p : places) figure.circle(p.x(), p.y(), 3.0, Fill{series.colour});
}

Figure figure_of(const LineChart& chart) {
  Figure figure(kAxesWidth, kHeight, chart.title);
  figure.text(0.0, 16.0, chart.title, {.size = kAxesLetters, .is_bold = true});
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (const LineSeries& series : chart.series) {
    for (const Eigen::Vector2d& p : drawn(series)) largest = largest.cwiseMax(p);
  }
  if (!(largest.x() > 0.0)) {
    figure.text(0.0, 50.0, "No values.", {.size = kAxesLetters, .colour = kFaintColour});
    return figure;
  }
  const double x_end = rounded_up(largest.x());
  const double y_end = largest.y() > 0.0 ? rounded_up(largest.y()) : 1.0;
  const double right = kAxesWidth - kAxesRight;
  const double bottom = kHeight - kBottom;
  const auto to_x = [&](double v) { return kAxesLeft + (right - kAxesLeft) * v / x_end; };
  const auto to_y = [&](double v) { return bottom - (bottom - kAxesTop) * v / y_end; };

  const Pen grid{.colour = kGridColour};
  const Ticks x_ticks = ticks_to(x_end);
  for (std::size_t i = 0; i < x_ticks.value.size(); ++i) {
    const double x = to_x(x_ticks.value[i]);
    figure.line(x, kAxesTop, x, bottom, grid);
    figure.text(x, bottom + 18.0, x_ticks.text[i],
                {.size = kAxesLetters, .align = Align::kCentre, .colour = kFaintColour});
  }
  const Ticks y_ticks = ticks_to(y_end);
  for (std::size_t i = 0; i < y_ticks.value.size(); ++i) {
    const double y = to_y(y_ticks.value[i]);
    figure.line(kAxesLeft, y, right, y, grid);
    figure.text(kAxesLeft - 8.0, y + 4.0, y_ticks.text[i],
                {.size = kAxesLetters, .align = Align::kRight, .colour = kFaintColour});
  }
  const Pen axis{.colour = kFaintColour};
  figure.line(kAxesLeft, kAxesTop, kAxesLeft, bottom, axis);
  figure.line(kAxesLeft, bottom, right, bottom, axis);
  const Lettering label{.size = kAxesLetters, .align = Align::kCentre};
  figure.text(0.5 * (kAxesLeft + right), bottom + 40.0, chart.x_label, label);
  Lettering upright = label;
  upright.turn = 90.0;
  figure.text(16.0, 0.5 * (kAxesTop + bottom), chart.y_label, upright);

  double legend = kAxesTop + 16.0;
  for (const LineSeries& series : chart.series) {
    std::vector<Eigen::Vector2d> places;
    for (const Eigen::Vector2d& p : drawn(series)) places.emplace_back(to_x(p.x()), to_y(p.y()));
    if (!places.empty()) add_series(figure, series, places);
    if (chart.series.size() < 2) continue;
    figure.line(kAxesLeft + 12.0, legend - 4.0, kAxesLeft + 36.0, legend - 4.0,
                {.colour = series.colour, .width = 2.0});
    figure.text(kAxesLeft + 42.0, legend, series.name, {.size = kAxesLetters});
    legend += 18.0;
  }
  return figure;
}

}  // namespace

std::string svg_line_chart(const LineChart& chart) { return svg_stack({chart}); }

std::string svg_stack(const std::vector<LineChart>& charts) {
  if (charts.empty()) return {};
  Figure stack(kAxesWidth, kHeight * static_cast<double>(charts.size()), charts.front().title);
  double y = 0.0;
  for (const LineChart& chart : charts) {
    stack.add(figure_of(chart), 0.0, y);
    y += kHeight;
  }
  return to_svg(stack);
}

}  // namespace palmar::report
