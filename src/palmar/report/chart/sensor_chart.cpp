// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/sensor_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "palmar/report/picture/colormap.h"

namespace palmar::report {
namespace {

constexpr double kSheet = 720.0;   // points; width of the figure
constexpr double kBetween = 18.0;  // panels
constexpr double kTitle = 22.0;
constexpr double kFoot = 40.0;  // scale
constexpr double kTallest = 420.0;
constexpr double kSmallLetters = 9.0;
constexpr int kFreePerLine = 8;
constexpr Rgb kNoPressureColour{238, 238, 234};
constexpr Rgb kMeasuredMore{33, 84, 160}, kSimulatedMore{178, 44, 34}, kEqual{248, 248, 246};

/// A cell's place in units of cells, y up.
struct PlacedCell {
  std::size_t cell = 0;
  double x = 0.0, y = 0.0, width = 1.0;
};
struct PlacedName {
  double x = 0.0, y = 0.0;
  std::string words;
};
struct Panel {
  double width = 1.0, height = 1.0;
  std::vector<PlacedCell> cells;
  std::vector<PlacedName> names;
};

bool is_pressed(const study::SensorReading& reading,
                const std::optional<study::PressureComparison>& measured, std::size_t i) {
  return reading.cells[i].force > 0.0 || (measured && measured->measured[i] > 0.0);
}

Panel mat_panel(const study::SensorReading& reading,
                const std::optional<study::PressureComparison>& measured) {
  constexpr int kMargin = 2;  // rows
  int low = reading.rows, high = 1;
  for (std::size_t i = 0; i < reading.cells.size(); ++i) {
    if (!is_pressed(reading, measured, i)) continue;
    low = std::min(low, reading.cells[i].row);
    high = std::max(high, reading.cells[i].row);
  }
  low = std::max(low - kMargin, 1);
  high = std::min(high + kMargin, reading.rows);
  Panel panel{static_cast<double>(reading.columns), static_cast<double>(high - low + 1), {}, {}};
  const double whole = reading.layout.pitch * reading.layout.pitch;
  for (std::size_t i = 0; i < reading.cells.size(); ++i) {
    const study::SensorCell& one = reading.cells[i];
    if (one.row < low || one.row > high || !(one.area > 0.0)) continue;
    panel.cells.push_back(
        {i, one.column - 1.0, static_cast<double>(one.row - low), one.area / whole});
  }
  return panel;
}

/// Patches of a glove: fingers side by side from the little one to the thumb, the palm below them.
Panel glove_panel(const study::SensorReading& reading) {
  std::map<std::string, std::array<double, 2>> corner;
  std::map<std::string, study::SensorPatch> patch;
  for (const study::SensorPatch& one : reading.layout.patches) {
    patch[std::string(name_of(one.region))] = one;
  }
  const auto find = [&](hand::Region region) {
    const auto found = patch.find(std::string(name_of(region)));
    return found == patch.end() ? nullptr : &found->second;
  };
  double x = 0.0;
  double below = 0.0;  // height of the palm
  const auto add_line = [&](std::initializer_list<hand::Region> regions) {
    double at = 0.0;
    int tallest = 0;
    for (const hand::Region region : regions) {
      if (const study::SensorPatch* one = find(region)) {
        corner[std::string(name_of(region))] = {at, below};
        at += one->columns + 1;
        tallest = std::max(tallest, one->rows);
      }
    }
    if (tallest > 0) below += tallest + 1;
    x = std::max(x, at);
  };
  add_line({hand::Region::kHypothenar, hand::Region::kCentralPalm, hand::Region::kThenar});
  add_line({hand::Region::kUlnarPalm, hand::Region::kRadialPalm});
  Panel panel{x, below, {}, {}};
  double at = 0.0;
  for (const hand::Finger finger :
       {hand::Finger::kLittle, hand::Finger::kRing, hand::Finger::kMiddle, hand::Finger::kIndex,
        hand::Finger::kThumb}) {
    double y = below;
    int widest = 0;
    for (const std::optional<hand::Segment>& segment : hand::segments_of(finger)) {
      if (!segment) continue;
      const study::SensorPatch* one = find(*hand::region_of(*segment));
      if (one == nullptr) continue;
      corner[std::string(name_of(one->region))] = {at, y};
      y += one->rows + 1;
      widest = std::max(widest, one->columns);
    }
    if (widest > 0) {
      panel.names.push_back({at, y - 0.4, std::string(name_of(finger))});
      at += widest + 1.5;
    }
    panel.height = std::max(panel.height, y + 1.0);
  }
  panel.width = std::max(panel.width, at);
  for (std::size_t i = 0; i < reading.cells.size(); ++i) {
    const study::SensorCell& one = reading.cells[i];
    const std::array<double, 2>& from = corner[one.patch];
    panel.cells.push_back({i, from[0] + one.column - 1.0, from[1] + one.row - 1.0});
  }
  return panel;
}

Panel free_panel(const study::SensorReading& reading) {
  const int count = static_cast<int>(reading.cells.size());
  const int lines = (count + kFreePerLine - 1) / kFreePerLine;
  Panel panel{2.0 * std::min(count, kFreePerLine), 2.0 * lines, {}, {}};
  for (int i = 0; i < count; ++i) {
    const double x = 2.0 * (i % kFreePerLine);
    const double y = 2.0 * (lines - 1 - i / kFreePerLine);
    panel.cells.push_back({static_cast<std::size_t>(i), x, y + 0.7});
    panel.names.push_back({x, y + 0.2, reading.cells[i].patch});
  }
  return panel;
}

Panel panel_of(const study::SensorReading& reading,
               const std::optional<study::PressureComparison>& measured) {
  if (reading.layout.kind == study::SensorKind::kMat) return mat_panel(reading, measured);
  return reading.layout.kind == study::SensorKind::kGlove ? glove_panel(reading)
                                                          : free_panel(reading);
}

Rgb mixed(const Rgb& from, const Rgb& to, double share) {
  const auto mix = [&](auto a, auto b) {
    return static_cast<std::uint8_t>(std::lround(a + share * (static_cast<double>(b) - a)));
  };
  return {mix(from.r, to.r), mix(from.g, to.g), mix(from.b, to.b)};
}

Rgb load_colour(double share) {
  return share > 0.0 ? map_colour(Colormap::kEmber, std::min(share, 1.0)) : kNoPressureColour;
}

Rgb difference_colour(double share) {
  const double size = std::min(std::abs(share), 1.0);
  return mixed(kEqual, share < 0.0 ? kMeasuredMore : kSimulatedMore, size);
}

/// A bar from `low` to `high`, MPa, in the colours of a panel.
template <class Colour>
void add_scale(Figure& figure, double x, double y, double width, double low, double high,
               const Colour& colour) {
  constexpr int kSteps = 48;
  for (int k = 0; k < kSteps; ++k) {
    const double share = low < 0.0 ? 2.0 * (k + 0.5) / kSteps - 1.0 : (k + 0.5) / kSteps;
    figure.rect(x + width * k / kSteps, y, width / kSteps + 0.4, 9.0, Fill{colour(share)});
  }
  const Lettering left{.size = kSmallLetters, .colour = kFaintColour};
  Lettering right = left;
  right.align = Align::kRight;
  figure.text(x, y + 21.0, fmt::format("{:.3g}", low), left);
  figure.text(x + width, y + 21.0, fmt::format("{:.3g} MPa", high), right);
}

}  // namespace

Figure sensor_figure(const study::SensorReading& reading,
                     const std::optional<study::PressureComparison>& measured) {
  const Panel panel = panel_of(reading, measured);
  const int count = measured ? 3 : 1;
  const double wide = (kSheet - kBetween * (count - 1)) / count;
  const double unit = std::min(wide / panel.width, kTallest / panel.height);
  const double tall = unit * panel.height;
  Figure figure(kSheet, kTitle + tall + kFoot,
                measured ? "Pressure on the sensor's cells: measured, simulated, and the difference"
                         : "Pressure on the sensor's cells");
  std::vector<double> ours, theirs, difference;
  double upper = 0.0, farthest = 0.0;
  for (std::size_t i = 0; i < reading.cells.size(); ++i) {
    const study::SensorCell& one = reading.cells[i];
    ours.push_back(one.mean_pressure);
    theirs.push_back(measured && one.area > 0.0 ? measured->measured[i] / one.area : 0.0);
    difference.push_back(ours.back() - theirs.back());
    upper = std::max({upper, ours.back(), theirs.back()});
    farthest = std::max(farthest, std::abs(difference.back()));
  }
  if (!(upper > 0.0)) upper = 1.0;
  if (!(farthest > 0.0)) farthest = 1.0;
  const auto draw = [&](int place, const std::string& title, const std::vector<double>& values,
                        double largest, double lowest, const auto& colour) {
    const double x = place * (wide + kBetween);
    figure.text(x, 13.0, title, {.size = 11.0, .is_bold = true});
    for (const PlacedCell& one : panel.cells) {
      figure.rect(x + unit * one.x, kTitle + tall - unit * (one.y + 1.0), unit * one.width, unit,
                  Fill{colour(values[one.cell] / largest)}, Pen{{255, 255, 255}, 0.4});
    }
    for (const PlacedName& one : panel.names) {
      figure.text(x + unit * one.x, kTitle + tall - unit * one.y, one.words,
                  {.size = std::min(kSmallLetters, 0.8 * unit + 2.0), .colour = kFaintColour});
    }
    add_scale(figure, x, kTitle + tall + 8.0, std::min(wide, 220.0), lowest, largest, colour);
  };
  if (!measured) {
    draw(0, "Simulated", ours, upper, 0.0, load_colour);
    return figure;
  }
  draw(0, "Measured", theirs, upper, 0.0, load_colour);
  draw(1, "Simulated", ours, upper, 0.0, load_colour);
  draw(2, "Simulated less measured", difference, farthest, -farthest, difference_colour);
  return figure;
}

}  // namespace palmar::report
