// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/image.h"

namespace palmar {

struct Bar {
  std::string label;
  double value = 0.0;  ///< in the chart's unit, 0 or more
  Rgb colour{70, 110, 150};
};

struct BarChart {
  std::string title;  ///< with the unit: "Force, N"
  std::vector<Bar> bars;
};

/// Horizontal bars with their values as a free-standing SVG element: no font file, no script; same
/// chart, same bytes. A chart without bars says so.
std::string svg_chart(const BarChart& chart);

}  // namespace palmar
