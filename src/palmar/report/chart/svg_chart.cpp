// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/svg_chart.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/picture/colour_bar.h"

namespace palmar {

namespace {

constexpr double kWidth = 560.0;
constexpr double kLeft = 250.0;  // labels
constexpr double kRight = 56.0;  // values
constexpr double kRow = 24.0;
constexpr double kTop = 34.0;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& colour,
                    const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor +
         "\" fill=\"" + colour + "\">" + html_escaped(text) + "</text>";
}

/// A line with end marks, white below black so that it shows on every colour.
std::string whisker(double from, double to, double y) {
  const std::string path = "M" + number(from) + " " + number(y - 4.0) + "v8M" + number(from) + " " +
                           number(y) + "H" + number(to) + "M" + number(to) + " " + number(y - 4.0) +
                           "v8";
  return "<path d=\"" + path +
         "\" stroke=\"#ffffff\" stroke-width=\"4\" fill=\"none\"/><path d=\"" + path +
         "\" stroke=\"#1d2329\" stroke-width=\"1.5\" fill=\"none\"/>";
}

}  // namespace

std::string svg_chart(const BarChart& chart) {
  const double height =
      kTop + kRow * static_cast<double>(std::max<std::size_t>(chart.bars.size(), 1)) + 26.0;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) +
                    " " + number(height) + "\" width=\"" + number(kWidth) + "\" height=\"" +
                    number(height) + "\" role=\"img\" aria-label=\"" + html_escaped(chart.title) +
                    "\" font-family=\"system-ui, sans-serif\" font-size=\"13\">";
  svg += "<text x=\"0\" y=\"16\" font-weight=\"600\" fill=\"#22282e\">" +
         html_escaped(chart.title) + "</text>";
  double largest = 0.0;
  for (const Bar& bar : chart.bars) {
    largest = std::max({largest, bar.value, bar.range ? bar.range->high : 0.0});
  }
  if (!(largest > 0.0)) {
    return svg + text_at(0.0, kTop + 16.0, "start", "#4a525a", "No contact.") + "</svg>";
  }
  const double upper = rounded_up(largest);
  const double span = kWidth - kLeft - kRight;
  const double bottom = kTop + kRow * static_cast<double>(chart.bars.size());
  const Ticks ticks = ticks_to(upper);
  for (std::size_t i = 0; i < ticks.value.size(); ++i) {
    const double x = kLeft + span * ticks.value[i] / upper;
    svg += "<line x1=\"" + number(x) + "\" x2=\"" + number(x) + "\" y1=\"" + number(kTop - 4.0) +
           "\" y2=\"" + number(bottom + 2.0) + "\" stroke=\"#dfe3e6\"/>";
    svg += text_at(x, bottom + 18.0, "middle", "#4a525a", ticks.text[i]);
  }
  for (std::size_t i = 0; i < chart.bars.size(); ++i) {
    const Bar& bar = chart.bars[i];
    const double y = kTop + kRow * static_cast<double>(i);
    const double length = span * std::max(bar.value, 0.0) / upper;
    svg += text_at(kLeft - 8.0, y + 15.0, "end", "#22282e", bar.label);
    svg += "<rect x=\"" + number(kLeft) + "\" y=\"" + number(y + 3.0) + "\" width=\"" +
           number(length) + "\" height=\"" + number(kRow - 8.0) + "\" fill=\"" +
           hex_colour(bar.colour) + "\" stroke=\"#4a525a\" stroke-width=\"0.5\"/>";
    double end = kLeft + length;
    if (bar.range) {
      svg += whisker(kLeft + span * std::max(bar.range->low, 0.0) / upper,
                     kLeft + span * std::max(bar.range->high, 0.0) / upper, y + 11.0);
      end = std::max(end, kLeft + span * bar.range->high / upper);
    }
    svg += text_at(end + 6.0, y + 15.0, "start", "#22282e", short_number(bar.value));
  }
  return svg + "</svg>";
}

}  // namespace palmar
