// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/bar_chart.h"

#include <algorithm>

#include "palmar/report/picture/colour_bar.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {

namespace {

constexpr double kBarsWidth = 560.0;
constexpr double kBarsLeft = 250.0;  // labels
constexpr double kBarsRight = 56.0;  // values
constexpr double kBarPitch = 24.0;
constexpr double kBarsTop = 34.0;
constexpr double kBarLetters = 13.0;

/// A line with end marks, white below black so that it shows on every colour.
void add_whisker(Figure& figure, double from, double to, double y) {
  for (const Pen& pen : {Pen{{255, 255, 255}, 4.0}, Pen{kInkColour, 1.5}}) {
    figure.line(from, y, to, y, pen);
    for (const double x : {from, to}) figure.line(x, y - 4.0, x, y + 4.0, pen);
  }
}

}  // namespace

Figure bar_figure(const BarChart& chart) {
  const double rows = static_cast<double>(std::max<std::size_t>(chart.bars.size(), 1));
  Figure figure(kBarsWidth, kBarsTop + kBarPitch * rows + 26.0, chart.title);
  figure.text(0.0, 16.0, chart.title, {.size = kBarLetters, .is_bold = true});
  double largest = 0.0;
  for (const Bar& bar : chart.bars) {
    largest = std::max({largest, bar.value, bar.range ? bar.range->high : 0.0});
  }
  if (!(largest > 0.0)) {
    figure.text(0.0, kBarsTop + 16.0, chart.when_empty,
                {.size = kBarLetters, .colour = kFaintColour});
    return figure;
  }
  const double upper = rounded_up(largest);
  const auto place = [&](double value) {
    return kBarsLeft + (kBarsWidth - kBarsLeft - kBarsRight) * std::max(value, 0.0) / upper;
  };
  const double bottom = kBarsTop + kBarPitch * rows;
  const Ticks ticks = ticks_to(upper);
  for (std::size_t i = 0; i < ticks.value.size(); ++i) {
    const double x = place(ticks.value[i]);
    figure.line(x, kBarsTop - 4.0, x, bottom + 2.0, {.colour = kGridColour});
    figure.text(x, bottom + 18.0, ticks.text[i],
                {.size = kBarLetters, .align = Align::kCentre, .colour = kFaintColour});
  }
  double y = kBarsTop;
  for (const Bar& bar : chart.bars) {
    figure.text(kBarsLeft - 8.0, y + 15.0, bar.label,
                {.size = kBarLetters, .align = Align::kRight});
    double end = place(bar.value);
    figure.rect(kBarsLeft, y + 3.0, end - kBarsLeft, kBarPitch - 8.0, Fill{bar.colour},
                Pen{kFaintColour, 0.5});
    if (bar.range) {
      add_whisker(figure, place(bar.range->low), place(bar.range->high), y + 11.0);
      end = std::max(end, place(bar.range->high));
    }
    figure.text(end + 6.0, y + 15.0, short_number(bar.value), {.size = kBarLetters});
    y += kBarPitch;
  }
  return figure;
}

}  // namespace palmar::report
