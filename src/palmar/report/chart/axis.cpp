// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace palmar::report {

Axis axis_over(double lowest, double highest, int steps) {
  const double magnitude = std::max({std::abs(lowest), std::abs(highest), 1e-30});
  if (!(highest - lowest > 1e-12 * magnitude)) {
    const double half = magnitude > 1e-29 ? 0.05 * magnitude : 1.0;
    lowest -= half;
    highest += half;
  }
  const double rough = (highest - lowest) / std::max(steps, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  Axis axis;
  const double first = std::floor(lowest / step + 1e-9);
  const double last = std::ceil(highest / step - 1e-9);
  axis.low = first * step;
  axis.high = last * step;
  for (double k = first; k <= last; k += 1.0) {
    axis.ticks.push_back(k * step);
    std::array<char, 400> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), k * step,
                                   std::chars_format::fixed, decimals)
                         .ptr;
    std::string tick(text.data(), end);
    if (tick.find_first_not_of("-0.") == tick.npos && tick.front() == '-') tick.erase(0, 1);
    axis.texts.push_back(tick);
  }
  return axis;
}

}  // namespace palmar::report
