// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/line_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/report/page/html_text.h"
#include "palmar/report/picture/colour_bar.h"

namespace palmar {
namespace {

constexpr double kWidth = 560.0;
constexpr double kHeight = 320.0;
constexpr double kLeft = 78.0;  // labels of y
constexpr double kRight = 20.0;
constexpr double kTop = 34.0;  // title
constexpr double kBottom = 52.0;
constexpr const char* kInk = "#22282e";
constexpr const char* kFaint = "#4a525a";

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& colour,
                    const std::string& text, const std::string& more = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor +
         "\" fill=\"" + colour + "\"" + more + ">" + html_escaped(text) + "</text>";
}

std::string line_at(double x1, double y1, double x2, double y2, const std::string& colour) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) +
         "\" y2=\"" + number(y2) + "\" stroke=\"" + colour + "\"/>";
}

std::vector<Eigen::Vector2d> drawn(const LineSeries& series) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& p : series.points) {
    if (p.allFinite()) points.push_back(p);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.x() < b.x(); });
  return points;
}

std::string opening(double height, const std::string& title) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + " " +
         number(height) + "\" width=\"" + number(kWidth) + "\" height=\"" + number(height) +
         "\" role=\"img\" aria-label=\"" + html_escaped(title) +
         "\" font-family=\"system-ui, sans-serif\" font-size=\"13\">";
}

/// The chart with its upper edge at `y`.
std::string drawing(const LineChart& chart, double y) {
  std::string svg = text_at(0.0, y + 16.0, "start", kInk, chart.title, " font-weight=\"600\"");
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (const LineSeries& series : chart.series) {
    for (const Eigen::Vector2d& p : drawn(series)) largest = largest.cwiseMax(p);
  }
  if (!(largest.x() > 0.0)) return svg + text_at(0.0, y + 50.0, "start", kFaint, "No values.");
  const double x_end = rounded_up(largest.x());
  const double y_end = largest.y() > 0.0 ? rounded_up(largest.y()) : 1.0;
  const double bottom = y + kHeight - kBottom;
  const double top = y + kTop;
  const auto to_x = [&](double v) { return kLeft + (kWidth - kLeft - kRight) * v / x_end; };
  const auto to_y = [&](double v) { return bottom - (bottom - top) * v / y_end; };

  const Ticks x_ticks = ticks_to(x_end);
  for (std::size_t i = 0; i < x_ticks.value.size(); ++i) {
    const double at = to_x(x_ticks.value[i]);
    svg += line_at(at, top, at, bottom, "#dfe3e6");
    svg += text_at(at, bottom + 18.0, "middle", kFaint, x_ticks.text[i]);
  }
  const Ticks y_ticks = ticks_to(y_end);
  for (std::size_t i = 0; i < y_ticks.value.size(); ++i) {
    const double at = to_y(y_ticks.value[i]);
    svg += line_at(kLeft, at, kWidth - kRight, at, "#dfe3e6");
    svg += text_at(kLeft - 8.0, at + 4.0, "end", kFaint, y_ticks.text[i]);
  }
  svg += line_at(kLeft, top, kLeft, bottom, kFaint) +
         line_at(kLeft, bottom, kWidth - kRight, bottom, kFaint);
  svg += text_at(0.5 * (kLeft + kWidth - kRight), bottom + 40.0, "middle", kInk, chart.x_label);
  const double middle = 0.5 * (top + bottom);
  svg += text_at(16.0, middle, "middle", kInk, chart.y_label,
                 " transform=\"rotate(-90 16.0 " + number(middle) + ")\"");

  double legend = top + 16.0;
  for (const LineSeries& series : chart.series) {
    const std::string colour = hex_colour(series.colour);
    std::string path;
    std::string marks;
    for (const Eigen::Vector2d& p : drawn(series)) {
      const std::string px = number(to_x(p.x()));
      const std::string py = number(to_y(p.y()));
      path += (path.empty() ? "" : " ") + px + "," + py;
      marks += "<circle cx=\"" + px + "\" cy=\"" + py + "\" r=\"3\" fill=\"" + colour + "\"/>";
    }
    svg += "<polyline points=\"" + path + "\" fill=\"none\" stroke=\"" + colour +
           "\" stroke-width=\"2\"/>" + marks;
    if (chart.series.size() < 2) continue;
    svg += line_at(kLeft + 12.0, legend - 4.0, kLeft + 36.0, legend - 4.0, colour);
    svg += text_at(kLeft + 42.0, legend, "start", kInk, series.name);
    legend += 18.0;
  }
  return svg;
}

}  // namespace

std::string svg_line_chart(const LineChart& chart) { return svg_stack({chart}); }

std::string svg_stack(const std::vector<LineChart>& charts) {
  const double height = kHeight * static_cast<double>(charts.size());
  std::string svg = opening(height, charts.empty() ? "" : charts.front().title);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    svg += drawing(charts[i], kHeight * static_cast<double>(i));
  }
  return svg + "</svg>";
}

}  // namespace palmar
