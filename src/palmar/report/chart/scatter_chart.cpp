// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/scatter_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "palmar/report/chart/axis.h"

namespace palmar::report {
namespace {

using Eigen::Vector2d;

constexpr double kScatterWidth = 420.0;  // points, as all lengths here
constexpr double kScatterLeft = 54.0;
constexpr double kScatterRight = 16.0;
constexpr double kScatterTop = 34.0;
constexpr double kPlotHeight = 250.0;
constexpr double kBelow = 40.0;  // ticks and label of x
constexpr double kLine = 12.0;   // of text

Rgb darker(Rgb c) {
  const auto half = [](std::uint8_t v) { return static_cast<std::uint8_t>(v * 3 / 5); };
  return {half(c.r), half(c.g), half(c.b)};
}

struct Plot {
  Axis x, y;
  Vector2d at(double px, double py) const {
    return {kScatterLeft + (kScatterWidth - kScatterLeft - kScatterRight) * x.share(px),
            kScatterTop + kPlotHeight * (1.0 - y.share(py))};
  }
};

/// The places of a line as far as they lie within the plot's height.
std::vector<Vector2d> inside(const Plot& plot, const std::vector<double>& x,
                             const std::vector<double>& y) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) {
    if (y[i] >= plot.y.low && y[i] <= plot.y.high) points.push_back(plot.at(x[i], y[i]));
  }
  return points;
}

/// The same, held at the plot's edges: for surfaces.
std::vector<Vector2d> clamped(const Plot& plot, const std::vector<double>& x,
                              const std::vector<double>& y) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) {
    points.push_back(plot.at(x[i], std::clamp(y[i], plot.y.low, plot.y.high)));
  }
  return points;
}

void draw_axes(Figure& figure, const Plot& plot, const ScatterChart& chart) {
  const Lettering tick{.size = 9.0, .colour = kFaintColour};
  for (std::size_t i = 0; i < plot.x.ticks.size(); ++i) {
    const Vector2d p = plot.at(plot.x.ticks[i], plot.y.low);
    figure.line(p.x(), kScatterTop, p.x(), p.y(), {kGridColour, 0.5});
    figure.text(p.x(), p.y() + 13.0, plot.x.texts[i],
                {.size = tick.size, .align = Align::kCentre, .colour = tick.colour});
  }
  for (std::size_t i = 0; i < plot.y.ticks.size(); ++i) {
    const Vector2d p = plot.at(plot.x.low, plot.y.ticks[i]);
    figure.line(p.x(), p.y(), kScatterWidth - kScatterRight, p.y(), {kGridColour, 0.5});
    figure.text(p.x() - 6.0, p.y() + 3.2, plot.y.texts[i],
                {.size = tick.size, .align = Align::kRight, .colour = tick.colour});
  }
  const double bottom = kScatterTop + kPlotHeight;
  figure.polyline({{kScatterLeft, kScatterTop},
                   {kScatterLeft, bottom},
                   {kScatterWidth - kScatterRight, bottom}},
                  {kFaintColour, 0.8});
  figure.text(0.5 * (kScatterLeft + kScatterWidth - kScatterRight), bottom + 30.0, chart.x_label,
              {.size = 10.0, .align = Align::kCentre});
  figure.text(14.0, kScatterTop + 0.5 * kPlotHeight, chart.y_label,
              {.size = 10.0, .align = Align::kCentre, .turn = 90.0});
}

void draw_bands(Figure& figure, const Plot& plot, const ScatterSeries& series) {
  const BandedLine& line = series.line;
  std::vector<Vector2d> outline = clamped(plot, line.x, line.low);
  std::vector<Vector2d> upper = clamped(plot, line.x, line.high);
  outline.insert(outline.end(), upper.rbegin(), upper.rend());
  figure.polygon(std::move(outline), Fill{series.colour, 0.3});
  for (const auto* edge : {&line.outer_low, &line.outer_high}) {
    figure.polyline(inside(plot, line.x, *edge), {darker(series.colour), 0.8, 3.0});
  }
  figure.polyline(inside(plot, line.x, line.value), {darker(series.colour), 1.6});
}

/// All points, each place of a series once: whole millimetres put many people on one.
void draw_points(Figure& figure, const Plot& plot, const std::vector<ScatterSeries>& all) {
  struct Place {
    Vector2d at;
    Rgb colour;
    int count = 0;
  };
  // In an order without pattern, so that no series covers the others.
  std::map<std::tuple<long, long, long, std::size_t>, Place> places;
  std::size_t count = 0;
  for (std::size_t s = 0; s < all.size(); ++s) {
    for (const Vector2d& p : all[s].points) {
      if (!p.allFinite()) continue;
      const Vector2d at = plot.at(p.x(), p.y());
      const long x = std::lround(at.x() * 20.0);
      const long y = std::lround(at.y() * 20.0);
      const long mixed = (x * 7919 + y * 104729 + static_cast<long>(s) * 1299709) % 10007;
      Place& place = places[{mixed, x, y, s}];
      place.at = at;
      place.colour = all[s].colour;
      ++place.count;
      ++count;
    }
  }
  const double radius = count > 1000 ? 1.4 : count > 200 ? 1.8 : 2.4;
  const double alone = count > 200 ? 0.45 : 0.75;
  for (const auto& [key, place] : places) {
    // A twentieth is enough of a difference, and keeps PDF's list of states short.
    const double opacity =
        std::round(std::min(0.9, alone + 0.15 * std::log2(place.count)) * 20.0) / 20.0;
    figure.circle(place.at.x(), place.at.y(), radius, Fill{place.colour, opacity});
  }
}

}  // namespace

Rgb series_colour(std::size_t place) {
  constexpr std::array<Rgb, 7> kColours{Rgb{0, 114, 178},   Rgb{213, 94, 0},   Rgb{0, 158, 115},
                                        Rgb{204, 121, 167}, Rgb{86, 180, 233}, Rgb{230, 159, 0},
                                        Rgb{90, 90, 90}};
  return kColours[place % kColours.size()];
}

Figure scatter_chart(const ScatterChart& chart) {
  const bool has_legend = chart.series.size() > 1;
  const double below = kBelow + kLine * static_cast<double>(chart.notes.size()) + 6.0 +
                       (has_legend ? kLine + 2.0 : 0.0);
  Figure figure(kScatterWidth, kScatterTop + kPlotHeight + below, chart.title);
  figure.rect(0.0, 0.0, figure.width(), figure.height(), Fill{kWhite});
  figure.text(kScatterLeft, 18.0, chart.title, {.size = 12.0, .is_bold = true});
  std::vector<double> xs, ys;
  for (const ScatterSeries& series : chart.series) {
    for (const Vector2d& p : series.points) {
      if (!p.allFinite()) continue;
      xs.push_back(p.x());
      ys.push_back(p.y());
    }
  }
  if (xs.empty()) {
    figure.text(kScatterLeft, kScatterTop + 20.0, "No values.", {.colour = kFaintColour});
    return figure;
  }
  const auto [x_low, x_high] = std::minmax_element(xs.begin(), xs.end());
  const auto [y_low, y_high] = std::minmax_element(ys.begin(), ys.end());
  // Bands belong into the picture, unless few points make them wide.
  const double reach = 0.5 * (*y_high - *y_low);
  double lowest = *y_low, highest = *y_high;
  for (const ScatterSeries& series : chart.series) {
    for (const double v : series.line.outer_low) lowest = std::min(lowest, v);
    for (const double v : series.line.outer_high) highest = std::max(highest, v);
  }
  const Plot plot{axis_over(*x_low, *x_high),
                  axis_over(std::max(lowest, *y_low - reach), std::min(highest, *y_high + reach))};
  draw_axes(figure, plot, chart);
  draw_points(figure, plot, chart.series);
  for (const ScatterSeries& series : chart.series) draw_bands(figure, plot, series);
  double y = kScatterTop + kPlotHeight + kBelow + 6.0;
  if (has_legend) {
    double x = kScatterLeft;
    for (const ScatterSeries& series : chart.series) {
      figure.circle(x + 3.0, y - 3.0, 3.0, Fill{series.colour});
      figure.text(x + 10.0, y, series.name, {.size = 9.0});
      x += 24.0 + text_width(series.name, {.size = 9.0});
    }
    y += kLine + 2.0;
  }
  for (const std::string& text : chart.notes) {
    figure.text(kScatterLeft, y, text, {.size = 9.0, .colour = kFaintColour});
    y += kLine;
  }
  return figure;
}

}  // namespace palmar::report
