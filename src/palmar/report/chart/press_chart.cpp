// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/press_chart.h"

#include "palmar/report/chart/line_chart.h"

namespace palmar::report {
namespace {

constexpr Rgb kBlue{70, 110, 150};
constexpr Rgb kRed{176, 74, 52};
constexpr Rgb kGreen{78, 126, 70};

LineSeries series_of(const std::vector<contact::PressStep>& steps,
                     double contact::PressStep::*value, const std::string& name, Rgb colour) {
  LineSeries series{name, {}, colour};
  for (const contact::PressStep& step : steps) series.points.emplace_back(step.depth, step.*value);
  return series;
}

}  // namespace

std::string press_chart(const std::vector<contact::PressStep>& steps, const std::string& title) {
  const std::string depth = "Depth, mm";
  return svg_stack({
      {title, depth, "Force, N", {series_of(steps, &contact::PressStep::force, "Force", kBlue)}},
      {"",
       depth,
       "Contact area, mm\u00b2",
       {series_of(steps, &contact::PressStep::area, "Area", kBlue)}},
      {"",
       depth,
       "Pressure, MPa",
       {series_of(steps, &contact::PressStep::peak_pressure, "Peak", kRed),
        series_of(steps, &contact::PressStep::peak_pressure_cells, "Peak on a sensor cell", kGreen),
        series_of(steps, &contact::PressStep::mean_pressure, "Mean", kBlue)}},
  });
}

}  // namespace palmar::report
