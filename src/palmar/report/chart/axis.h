// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palmar::report {

/// An axis that needn't begin at 0: round ends that take in all values, round ticks.
struct Axis {
  double low = 0.0, high = 1.0;
  std::vector<double> ticks;
  std::vector<std::string> texts;  ///< with just the decimals that the step needs
  /// Share of the way from low to high, 0 to 1 inside.
  double share(double value) const { return (value - low) / (high - low); }
};

/// Steps of 1, 2 or 5 x 10^n, about `steps` of them. One value alone stands in the middle.
Axis axis_over(double lowest, double highest, int steps = 6);

}  // namespace palmar::report
