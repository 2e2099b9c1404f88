// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

struct LineSeries {
  std::string name;                     ///< in the legend; none with a single series
  std::vector<Eigen::Vector2d> points;  ///< 0 or more both; joined in the order of x
  Rgb colour{70, 110, 150};
};

struct LineChart {
  std::string title;
  std::string x_label;  ///< with the unit: "Depth, mm"
  std::string y_label;
  std::vector<LineSeries> series;
};

/// Lines with a mark at every point, both axes from 0, as a free-standing SVG element: no font
/// file, no script; same chart, same bytes. Points that are not finite are left out; a chart
/// without points says so.
std::string svg_line_chart(const LineChart& chart);

/// Charts below one another in one SVG element.
std::string svg_stack(const std::vector<LineChart>& charts);

}  // namespace palmar::report
