// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/study_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "palmar/statistics/summary.h"

namespace palmar::report {
namespace {

constexpr double kRowsWidth = 560.0;  // points, as all below
constexpr double kRowsLeft = 62.0;
constexpr double kTextSize = 12.0;
constexpr double kSmallSize = 11.0;
constexpr double kHistogram = 150.0;  // height of the bars' panel
constexpr double kRow = 46.0;         // height of a sample's row
constexpr double kDot = 2.1;          // radius
constexpr double kBracket = 19.0;     // width of a bracket's column
constexpr int kMostBins = 14;
constexpr std::size_t kMostDots = 2400;  // of one chart; more are neither seen nor small

std::string number(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  const std::string result = text.data();
  return result.find_first_not_of("-0.") == std::string::npos && result.starts_with("-")
             ? result.substr(1)
             : result;
}

std::string shortened(const std::string& text, const Lettering& look, double width) {
  if (text_width(text, look) <= width) return text;
  std::string cut = text;
  while (cut.size() > 1 && text_width(cut + "...", look) > width) {
    // Not through the middle of a letter of UTF-8.
    do {
      cut.pop_back();
    } while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xc0U) == 0xc0U);
  }
  return cut + "...";
}

void title(Figure& figure, const std::string& text) {
  Lettering look{.size = 14.0, .is_bold = true};
  while (look.size > 9.5 && text_width(text, look) > figure.width() - 8.0) look.size -= 0.5;
  figure.text(4.0, 17.0, shortened(text, look, figure.width() - 8.0), look);
}

/// Maps values of an axis to points.
struct Scale {
  RoundAxis axis;
  double from = 0.0, to = 1.0;
  double operator()(double value) const {
    return from + (to - from) * (value - axis.low) / (axis.high - axis.low);
  }
};

void x_axis(Figure& figure, const Scale& x, double y, const std::string& label) {
  figure.line(x.from, y, x.to, y, {.colour = kFaintColour});
  for (std::size_t i = 0; i < x.axis.ticks.size(); ++i) {
    const double at = x(x.axis.ticks[i]);
    figure.line(at, y, at, y + 4.0, {.colour = kFaintColour});
    figure.text(at, y + 15.0, x.axis.text[i],
                {.size = kSmallSize, .align = Align::kCentre, .colour = kFaintColour});
  }
  figure.text(0.5 * (x.from + x.to), y + 33.0, label, {.size = kTextSize, .align = Align::kCentre});
}

void y_axis(Figure& figure, const Scale& y, double x_from, double x_to, const std::string& label) {
  for (std::size_t i = 0; i < y.axis.ticks.size(); ++i) {
    const double at = y(y.axis.ticks[i]);
    figure.line(x_from, at, x_to, at, {.colour = kGridColour, .width = 0.8});
    figure.text(x_from - 5.0, at + 3.4, y.axis.text[i],
                {.size = kSmallSize, .align = Align::kRight, .colour = kFaintColour});
  }
  figure.text(13.0, 0.5 * (y.from + y.to), label,
              {.size = kTextSize, .align = Align::kCentre, .turn = 90.0});
}

/// Largest and smallest value of all samples; nothing without values.
std::optional<statistics::Interval> range_of(const std::vector<ChartSample>& samples) {
  std::optional<statistics::Interval> range;
  for (const ChartSample& sample : samples) {
    for (const double value : sample.values) {
      if (!range) range = statistics::Interval{value, value};
      range->low = std::min(range->low, value);
      range->high = std::max(range->high, value);
    }
  }
  return range;
}

/// Bars of all samples side by side in every bin, share of hands in per cent.
void histogram(Figure& figure, const DistributionChart& chart, const Scale& x, double top) {
  const RoundAxis& axis = x.axis;
  // A bin is the axis' step or a half or fifth of it: the finest that gives few enough bins.
  double bin = axis.step;
  for (const double part : {2.0, 4.0, 5.0}) {
    if ((axis.high - axis.low) / (axis.step / part) <= kMostBins + 0.5) bin = axis.step / part;
  }
  const int bins = std::max(1, static_cast<int>(std::lround((axis.high - axis.low) / bin)));
  std::vector<std::vector<double>> share(chart.samples.size(),
                                         std::vector<double>(static_cast<std::size_t>(bins), 0.0));
  double largest = 0.0;
  for (std::size_t s = 0; s < chart.samples.size(); ++s) {
    const std::vector<double>& values = chart.samples[s].values;
    for (const double value : values) {
      const int k = std::clamp(static_cast<int>(std::floor((value - axis.low) / bin)), 0, bins - 1);
      double& one = share[s][static_cast<std::size_t>(k)];
      one += 100.0 / static_cast<double>(values.size());
      largest = std::max(largest, one);
    }
  }
  const Scale y{round_axis(0.0, std::max(largest, 1.0), 3), top + kHistogram, top};
  y_axis(figure, y, x.from, x.to, "Share of hands, %");
  const double bin_width = (x.to - x.from) / bins;
  const double bar = 0.86 * bin_width / static_cast<double>(chart.samples.size());
  for (std::size_t s = 0; s < chart.samples.size(); ++s) {
    for (int k = 0; k < bins; ++k) {
      const double value = share[s][static_cast<std::size_t>(k)];
      if (value <= 0.0) continue;
      const double left = x.from + bin_width * (k + 0.07) + bar * static_cast<double>(s);
      figure.rect(left, y(value), bar, y(0.0) - y(value), Fill{chart.samples[s].colour});
    }
  }
  figure.line(x.from, y(0.0), x.to, y(0.0), {.colour = kFaintColour});
}

/// Every how manieth hand is drawn as a dot.
std::size_t thinning(const std::vector<ChartSample>& samples) {
  std::size_t dots = 0;
  for (const ChartSample& sample : samples) dots += sample.values.size();
  return dots / kMostDots + 1;
}

std::string dot_words(std::size_t every) {
  return every == 1 ? "Dot: one hand." : "Dot: every " + std::to_string(every) + "th hand.";
}

/// Dots beside one another where they would cover each other.
void dots(Figure& figure, const ChartSample& sample, const Scale& x, double y, double room,
          std::size_t every) {
  std::map<long, std::vector<double>> column;
  for (std::size_t i = 0; i < sample.values.size(); i += every) {
    const double at = x(sample.values[i]);
    column[std::lround(at / (2.0 * kDot))].push_back(at);
  }
  std::size_t most = 1;
  for (const auto& [key, xs] : column) most = std::max(most, xs.size());
  const double step = std::min(2.0 * kDot, room / static_cast<double>(most));
  for (const auto& [key, xs] : column) {
    for (std::size_t i = 0; i < xs.size(); ++i) {
      figure.circle(xs[i], y - step * (static_cast<double>(i)), kDot, Fill{sample.colour, 0.75});
    }
  }
}

void sample_row(Figure& figure, const ChartSample& sample, const Scale& x, double top,
                std::size_t every) {
  std::vector<double> sorted = sample.values;
  std::sort(sorted.begin(), sorted.end());
  const Lettering look{.size = kSmallSize};
  const std::string count = " (" + std::to_string(sorted.size()) + " hands)";
  figure.rect(x.from, top + 3.5, 9.0, 9.0, Fill{sample.colour});
  figure.text(x.from + 13.0, top + 11.5,
              shortened(sample.name, look, x.to - x.from - 14.0 - text_width(count, look)) + count,
              look);
  if (sorted.empty()) return;
  const double base = top + kRow - 9.0;
  dots(figure, sample, x, base - 8.0, kRow - 29.0, every);
  const double mean = statistics::summarise(sorted).mean;
  const double low = x(statistics::quantile(sorted, 0.05)),
               high = x(statistics::quantile(sorted, 0.95));
  const double q1 = x(statistics::quantile(sorted, 0.25)),
               q3 = x(statistics::quantile(sorted, 0.75));
  const double median = x(statistics::quantile(sorted, 0.5));
  figure.line(low, base, q1, base);
  figure.line(q3, base, high, base);
  figure.line(low, base - 3.0, low, base + 3.0);
  figure.line(high, base - 3.0, high, base + 3.0);
  figure.rect(q1, base - 4.0, q3 - q1, 8.0, Fill{kWhite}, Pen{});
  figure.line(median, base - 5.0, median, base + 5.0, {.width = 2.4});
  const double m = x(mean);
  figure.polygon({{m, base - 3.2}, {m + 3.2, base}, {m, base + 3.2}, {m - 3.2, base}},
                 Fill{sample.colour}, Pen{.width = 0.7});
}

void bracket(Figure& figure, const ChartBracket& one, double x, double rows_top) {
  const double from = rows_top + kRow * (one.first + 0.5);
  const double to = rows_top + kRow * (one.second + 0.5);
  const Rgb colour = one.is_shown ? kInkColour : Rgb{150, 157, 164};
  const Pen pen{.colour = colour, .width = one.is_shown ? 1.1 : 0.8};
  figure.line(x, from, x, to, pen);
  figure.line(x - 3.5, from, x, from, pen);
  figure.line(x - 3.5, to, x, to, pen);
  figure.text(x + 11.0, 0.5 * (from + to), one.text,
              {.size = 9.5, .align = Align::kCentre, .turn = 90.0, .colour = colour});
}

}  // namespace

Rgb product_colour(int product) {
  // Okabe and Ito's set, the yellow darkened to be seen on white.
  static constexpr std::array<Rgb, 7> kColours = {
      Rgb{0, 114, 178},  Rgb{213, 94, 0},   Rgb{0, 158, 115}, Rgb{204, 121, 167},
      Rgb{86, 180, 233}, Rgb{184, 134, 11}, Rgb{90, 90, 90}};
  return kColours[static_cast<std::size_t>(product) % kColours.size()];
}

RoundAxis round_axis(double low, double high, int fewest) {
  if (!(high > low)) {
    const double room = low == 0.0 ? 1.0 : 0.05 * std::abs(low);
    low -= room;
    high += room;
  }
  const double raw = (high - low) / fewest;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = power;
  for (const double factor : {2.0, 5.0}) {
    if (factor * power <= raw * (1.0 + 1e-9)) step = factor * power;
  }
  RoundAxis axis;
  axis.step = step;
  const auto first = static_cast<long>(std::floor(low / step + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / step - 1e-9));
  axis.low = static_cast<double>(first) * step;
  axis.high = static_cast<double>(last) * step;
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  for (long k = first; k <= last; ++k) {
    axis.ticks.push_back(static_cast<double>(k) * step);
    axis.text.push_back(number(axis.ticks.back(), decimals));
  }
  return axis;
}

Figure distribution_figure(const DistributionChart& chart) {
  const auto rows = static_cast<double>(chart.samples.size());
  const double side = 8.0 + kBracket * static_cast<double>(chart.brackets.size());
  const double rows_top = 30.0 + kHistogram + 8.0;
  const double bottom = rows_top + kRow * rows;
  Figure figure(kRowsWidth + std::max(0.0, side - 100.0), bottom + 60.0, chart.title);
  title(figure, chart.title);
  const std::optional<statistics::Interval> range = range_of(chart.samples);
  if (!range) {
    figure.text(kRowsLeft, 60.0, "No hand has a value.", {.size = kTextSize});
    return figure;
  }
  const Scale x{round_axis(range->low, range->high), kRowsLeft, figure.width() - 14.0 - side};
  histogram(figure, chart, x, 30.0);
  for (const double tick : x.axis.ticks) {
    figure.line(x(tick), rows_top, x(tick), bottom, {.colour = kGridColour, .width = 0.8});
  }
  const std::size_t every = thinning(chart.samples);
  for (std::size_t s = 0; s < chart.samples.size(); ++s) {
    sample_row(figure, chart.samples[s], x, rows_top + kRow * static_cast<double>(s), every);
  }
  for (std::size_t b = 0; b < chart.brackets.size(); ++b) {
    bracket(figure, chart.brackets[b], x.to + 14.0 + kBracket * static_cast<double>(b), rows_top);
  }
  x_axis(figure, x, bottom, chart.x_label);
  figure.text(kRowsLeft, bottom + 52.0,
              dot_words(every) +
                  " Box: quartiles, bar: median, diamond: mean, whiskers: 5th and 95th percentile.",
              {.size = 9.5, .colour = kFaintColour});
  return figure;
}

Figure share_figure(const std::string& heading, const std::string& x_label,
                    const std::vector<ShareBar>& bars) {
  constexpr double kBarRow = 34.0;
  const double bottom = 32.0 + kBarRow * static_cast<double>(bars.size());
  Figure figure(kRowsWidth, bottom + 42.0, heading);
  title(figure, heading);
  Scale x{round_axis(0.0, 100.0, 5), 14.0, kRowsWidth - 110.0};
  for (const double tick : x.axis.ticks) {
    figure.line(x(tick), 28.0, x(tick), bottom, {.colour = kGridColour, .width = 0.8});
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const ShareBar& bar = bars[i];
    const double top = 32.0 + kBarRow * static_cast<double>(i);
    const Lettering look{.size = kSmallSize};
    figure.text(x.from, top + 9.0, shortened(bar.name, look, x.to - x.from), look);
    const double middle = top + 20.0;
    figure.rect(x(0.0), middle - 6.0, x(100.0 * bar.share) - x(0.0), 12.0, Fill{bar.colour});
    const double low = x(100.0 * bar.low), high = x(100.0 * bar.high);
    for (const Pen& pen : {Pen{.colour = kWhite, .width = 3.0}, Pen{.width = 1.2}}) {
      figure.line(low, middle, high, middle, pen);
      figure.line(low, middle - 4.0, low, middle + 4.0, pen);
      figure.line(high, middle - 4.0, high, middle + 4.0, pen);
    }
    figure.text(x.to + 10.0, middle + 3.4, bar.text, look);
  }
  x_axis(figure, x, bottom, x_label);
  return figure;
}

Figure trend_figure(const TrendChart& chart) {
  constexpr double kPanel = 250.0;
  const double bottom = 30.0 + kPanel;
  const auto legend = static_cast<double>(chart.samples.size() + 1) / 2;
  Figure figure(kRowsWidth, bottom + 44.0 + 15.0 * std::floor(legend) + 4.0, chart.title);
  title(figure, chart.title);
  std::vector<ChartSample> ys, xs;
  for (const TrendSample& one : chart.samples) {
    ys.push_back(one.sample);
    xs.push_back({"", {}, one.x});
    for (const auto& p : one.line) {
      ys.back().values.push_back(p.low);
      ys.back().values.push_back(p.high);
    }
  }
  const std::size_t every = thinning(xs);
  const auto x_range = range_of(xs), y_range = range_of(ys);
  if (!x_range || !y_range) {
    figure.text(kRowsLeft, 60.0, "No hand has a value.", {.size = kTextSize});
    return figure;
  }
  const Scale x{round_axis(x_range->low, x_range->high, 5), kRowsLeft, kRowsWidth - 16.0};
  const Scale y{round_axis(y_range->low, y_range->high), bottom, 30.0};
  y_axis(figure, y, x.from, x.to, chart.y_label);
  for (const TrendSample& one : chart.samples) {
    if (one.line.empty()) continue;
    std::vector<Eigen::Vector2d> band;
    for (const auto& p : one.line) band.emplace_back(x(p.x), y(p.high));
    for (auto p = one.line.rbegin(); p != one.line.rend(); ++p)
      band.emplace_back(x(p->x), y(p->low));
    figure.polygon(std::move(band), Fill{one.sample.colour, 0.15});
  }
  for (const TrendSample& one : chart.samples) {
    for (std::size_t i = 0; i < one.x.size(); i += every) {
      figure.circle(x(one.x[i]), y(one.sample.values[i]), kDot, Fill{one.sample.colour, 0.75});
    }
    std::vector<Eigen::Vector2d> line;
    for (const auto& p : one.line) line.emplace_back(x(p.x), y(p.y));
    if (!line.empty()) {
      figure.polyline(std::move(line), {.colour = one.sample.colour, .width = 1.8});
    }
  }
  x_axis(figure, x, bottom, chart.x_label);
  for (std::size_t s = 0; s < chart.samples.size(); ++s) {
    const double left = kRowsLeft + (s % 2 == 0 ? 0.0 : 0.5 * (kRowsWidth - kRowsLeft));
    const double at = bottom + 50.0 + 15.0 * static_cast<double>(s / 2);
    const Lettering look{.size = kSmallSize};
    figure.rect(left, at - 8.0, 9.0, 9.0, Fill{chart.samples[s].sample.colour});
    figure.text(
        left + 13.0, at,
        shortened(chart.samples[s].sample.name, look, 0.5 * (kRowsWidth - kRowsLeft) - 18.0), look);
  }
  return figure;
}

}  // namespace palmar::report
