// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/report/chart/figure.h"

namespace palmar::report {

/// Colour of a product in all charts of a study, by its place in the plan; distinguished by every
/// kind of colour vision up to 7 (after Okabe and Ito 2008), repeated beyond.
Rgb product_colour(int product);

/// Round axis from at or below `low` to at or above `high`: ticks at multiples of 1, 2 or 5 x 10^n,
/// `fewest` to about two and a half times as many intervals; texts with just the decimals that the
/// step needs. A range of no length is widened.
struct RoundAxis {
  double low = 0.0, high = 1.0, step = 1.0;
  std::vector<double> ticks;
  std::vector<std::string> text;
};
RoundAxis round_axis(double low, double high, int fewest = 4);

struct ChartSample {
  std::string name;
  Rgb colour;
  std::vector<double> values;
};

/// A difference between two samples, shown as a bracket.
struct ChartBracket {
  int first = 0, second = 0;  ///< samples
  std::string text;           ///< "p < 0.001"
  bool is_shown = true;       ///< false: drawn faint
};

/// Samples of one quantity, each over hands: above a histogram with a bar per sample in every bin
/// (share of hands, as figures 5-14 and 5-15 of Xie 2014), below a row per sample with a dot per
/// hand, a box from quartile to quartile with the median, whiskers to the 5th and 95th percentile,
/// and the mean as a diamond; brackets at the right.
struct DistributionChart {
  std::string title;
  std::string x_label;  ///< with the unit
  std::vector<ChartSample> samples;
  std::vector<ChartBracket> brackets;
};
Figure distribution_figure(const DistributionChart& chart);

/// Shares from 0 to 100 % with their intervals as horizontal bars.
struct ShareBar {
  std::string name;
  Rgb colour;
  double share = 0.0, low = 0.0, high = 0.0;  ///< 0 to 1
  std::string text;                           ///< behind the bar: "27 of 30"
};
Figure share_figure(const std::string& title, const std::string& x_label,
                    const std::vector<ShareBar>& bars);

/// Dots of samples over a common x with their fitted lines and bands.
struct TrendSample {
  ChartSample sample;     ///< values: y
  std::vector<double> x;  ///< one per value
  struct Point {
    double x = 0.0, y = 0.0, low = 0.0, high = 0.0;
  };
  std::vector<Point> line;  ///< ascending in x; empty: dots alone
};
struct TrendChart {
  std::string title, x_label, y_label;
  std::vector<TrendSample> samples;
};
Figure trend_figure(const TrendChart& chart);

}  // namespace palmar::report
