// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/chart/figure.h"

namespace palmar::report {

/// A line through points and the bands round it, at rising x.
struct BandedLine {
  std::vector<double> x, value;
  std::vector<double> low, high;              ///< of the mean: shaded; may be empty
  std::vector<double> outer_low, outer_high;  ///< of single values: dashed; may be empty
};

struct ScatterSeries {
  std::string name;  ///< in the legend; none with a single series
  std::vector<Eigen::Vector2d> points;
  BandedLine line;  ///< empty: points only
  Rgb colour{70, 110, 150};
};

struct ScatterChart {
  std::string title;
  std::string x_label;  ///< with the unit: "hand length, mm"
  std::string y_label;
  std::vector<ScatterSeries> series;
  std::vector<std::string> notes;  ///< below the chart: equation, R2 ...
};

/// Colours of series one after another; distinguished by people with any colour vision (Wong 2011).
Rgb series_colour(std::size_t place);

/// Points that lie on one another are drawn once and darker. Points that are not finite are left
/// out; a chart without points says so.
Figure scatter_chart(const ScatterChart& chart);

}  // namespace palmar::report
