// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/line_chart.h"

#include <algorithm>

#include "palmar/report/chart/figure.h"
#include "palmar/report/picture/colour_bar.h"

namespace palmar {
namespace {

constexpr double kWidth = 560.0;
constexpr double kHeight = 320.0;
constexpr double kLeft = 78.0;  // labels of y
constexpr double kRight = 20.0;
constexpr double kTop = 34.0;  // title
constexpr double kBottom = 52.0;
constexpr double kLetters = 13.0;

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
  Figure figure(kWidth, kHeight, chart.title);
  figure.text(0.0, 16.0, chart.title, {.size = kLetters, .is_bold = true});
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (const LineSeries& series : chart.series) {
    for (const Eigen::Vector2d& p : drawn(series)) largest = largest.cwiseMax(p);
  }
  if (!(largest.x() > 0.0)) {
    figure.text(0.0, 50.0, "No values.", {.size = kLetters, .colour = kFaintColour});
    return figure;
  }
  const double x_end = rounded_up(largest.x());
  const double y_end = largest.y() > 0.0 ? rounded_up(largest.y()) : 1.0;
  const double right = kWidth - kRight;
  const double bottom = kHeight - kBottom;
  const auto to_x = [&](double v) { return kLeft + (right - kLeft) * v / x_end; };
  const auto to_y = [&](double v) { return bottom - (bottom - kTop) * v / y_end; };

  const Pen grid{.colour = kGridColour};
  const Ticks x_ticks = ticks_to(x_end);
  for (std::size_t i = 0; i < x_ticks.value.size(); ++i) {
    const double x = to_x(x_ticks.value[i]);
    figure.line(x, kTop, x, bottom, grid);
    figure.text(x, bottom + 18.0, x_ticks.text[i],
                {.size = kLetters, .align = Align::kCentre, .colour = kFaintColour});
  }
  const Ticks y_ticks = ticks_to(y_end);
  for (std::size_t i = 0; i < y_ticks.value.size(); ++i) {
    const double y = to_y(y_ticks.value[i]);
    figure.line(kLeft, y, right, y, grid);
    figure.text(kLeft - 8.0, y + 4.0, y_ticks.text[i],
                {.size = kLetters, .align = Align::kRight, .colour = kFaintColour});
  }
  const Pen axis{.colour = kFaintColour};
  figure.line(kLeft, kTop, kLeft, bottom, axis);
  figure.line(kLeft, bottom, right, bottom, axis);
  const Lettering label{.size = kLetters, .align = Align::kCentre};
  figure.text(0.5 * (kLeft + right), bottom + 40.0, chart.x_label, label);
  Lettering upright = label;
  upright.turn = 90.0;
  figure.text(16.0, 0.5 * (kTop + bottom), chart.y_label, upright);

  double legend = kTop + 16.0;
  for (const LineSeries& series : chart.series) {
    std::vector<Eigen::Vector2d> places;
    for (const Eigen::Vector2d& p : drawn(series)) places.emplace_back(to_x(p.x()), to_y(p.y()));
    if (!places.empty()) add_series(figure, series, places);
    if (chart.series.size() < 2) continue;
    figure.line(kLeft + 12.0, legend - 4.0, kLeft + 36.0, legend - 4.0,
                {.colour = series.colour, .width = 2.0});
    figure.text(kLeft + 42.0, legend, series.name, {.size = kLetters});
    legend += 18.0;
  }
  return figure;
}

}  // namespace

std::string svg_line_chart(const LineChart& chart) { return svg_stack({chart}); }

std::string svg_stack(const std::vector<LineChart>& charts) {
  if (charts.empty()) return {};
  Figure stack(kWidth, kHeight * static_cast<double>(charts.size()), charts.front().title);
  double y = 0.0;
  for (const LineChart& chart : charts) {
    stack.add(figure_of(chart), 0.0, y);
    y += kHeight;
  }
  return to_svg(stack);
}

}  // namespace palmar
