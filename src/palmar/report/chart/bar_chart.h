// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/report/chart/figure.h"

namespace palmar::report {

/// Low and high value of a quantity that is not known for certain.
struct BarRange {
  double low = 0.0, high = 0.0;  ///< in the chart's unit, 0 or more
};

struct Bar {
  std::string label;
  double value = 0.0;  ///< in the chart's unit, 0 or more
  Rgb colour{70, 110, 150};
  std::optional<BarRange> range{};  ///< drawn as a line across the bar's end
};

struct BarChart {
  std::string title;  ///< with the unit: "Force, N"
  std::vector<Bar> bars;
  std::string when_empty = "Nothing to show.";  ///< what is missing: a sentence
};

/// Horizontal bars with their values; `when_empty` where none is above 0.
Figure bar_figure(const BarChart& chart);

}  // namespace palmar::report
