// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/correlation_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"

namespace palmar::report {
namespace {

constexpr std::size_t kMostNumbers = 20;

std::string number(double r) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%.2f", r);
  return text.data();
}

Rgb colour_of(double r) {
  constexpr Rgb kLow{0, 90, 160}, kHigh{200, 85, 0};
  const Rgb end = r < 0.0 ? kLow : kHigh;
  const double share = std::min(std::abs(r), 1.0);
  const auto mixed = [&](std::uint8_t c) {
    return static_cast<std::uint8_t>(std::lround(255.0 + share * (c - 255.0)));
  };
  return {mixed(end.r), mixed(end.g), mixed(end.b)};
}

}  // namespace

Figure correlation_chart(const CorrelationChart& chart) {
  const auto count = static_cast<Eigen::Index>(chart.names.size());
  if (chart.r.rows() != count || chart.r.cols() != count || chart.is_significant.rows() != count ||
      chart.is_significant.cols() != count) {
    throw UsageError("correlation chart: " + std::to_string(count) + " names for " +
                     std::to_string(chart.r.rows()) + " x " + std::to_string(chart.r.cols()) +
                     " numbers");
  }
  const bool has_numbers = chart.names.size() <= kMostNumbers;
  const double cell = has_numbers ? 34.0 : 16.0;
  const Lettering label{.size = has_numbers ? 10.0 : 8.0};
  double longest = 40.0;
  for (const std::string& name : chart.names) longest = std::max(longest, text_width(name, label));
  const double left = longest + 18.0;
  const double top = 34.0;
  const double side = cell * static_cast<double>(count);
  // Names stand at the diagonal's right as well, so that no column is without one.
  Figure figure(std::max(left + side + longest + 12.0,
                         20.0 + text_width(chart.title, {.size = 12.0, .is_bold = true})),
                top + side + 34.0, chart.title);
  figure.rect(0.0, 0.0, figure.width(), figure.height(), Fill{kWhite});
  figure.text(10.0, 18.0, chart.title, {.size = 12.0, .is_bold = true});
  for (Eigen::Index i = 0; i < count; ++i) {
    const double y = top + cell * static_cast<double>(i);
    const std::string& name = chart.names[static_cast<std::size_t>(i)];
    figure.text(left - 6.0, y + 0.5 * cell + 3.4, name,
                {.size = label.size, .align = Align::kRight});
    for (Eigen::Index j = 0; j < i; ++j) {
      const double x = left + cell * static_cast<double>(j);
      const double r = chart.r(i, j);
      figure.rect(x, y, cell, cell, Fill{colour_of(r)}, Pen{kWhite, 1.0});
      if (!has_numbers) continue;
      const Rgb ink = chart.is_significant(i, j) ? kInkColour : Rgb{150, 155, 160};
      figure.text(x + 0.5 * cell, y + 0.5 * cell + 3.4, number(r),
                  {.size = 9.5, .align = Align::kCentre, .colour = ink});
    }
    figure.text(left + cell * static_cast<double>(i) + 6.0, y + 0.5 * cell + 3.4, name,
                {.size = label.size, .colour = kFaintColour});
  }
  figure.text(left, top + side + 20.0,
              has_numbers ? "Pearson's r; grey: not significant at 0.05" : "Pearson's r",
              {.size = 9.0, .colour = kFaintColour});
  return figure;
}

}  // namespace palmar::report
