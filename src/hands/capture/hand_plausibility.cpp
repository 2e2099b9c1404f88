// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/hand_plausibility.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/statistics/median.h"

namespace palmar::capture {

std::vector<std::string> impossible_dimensions(const hand::HandDimensions& found,
                                               const hand::HandDimensions& model) {
  constexpr double kCreaseAside = 2.0;  // mm; of the short segments it is a large share
  struct Ratio {
    std::string what;
    double value, expected;
    double slack = 0.0;
  };
  std::vector<Ratio> all;
  std::vector<double> ratios;
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions &mine = found.segment[s], &usual = model.segment[s];
    const std::string name(name_of(static_cast<hand::Segment>(s)));
    all.push_back({name + " is {:.0f} mm long", mine.length, usual.length, kCreaseAside});
    all.push_back({name + " is {:.0f} mm wide", mine.width, usual.width});
    all.push_back({name + " is {:.0f} mm thick", mine.thickness, usual.thickness});
  }
  for (const Ratio& one : all) ratios.push_back(one.value / one.expected);
  const double size = statistics::median(std::move(ratios));
  std::vector<std::string> clauses;
  for (const Ratio& one : all) {
    const double expected = size * one.expected;
    if (one.value + one.slack >= 0.45 * expected && one.value <= 2.2 * expected) continue;
    clauses.push_back(fmt::format(fmt::runtime(one.what + ", where about {:.0f} mm are expected"),
                                  one.value, expected));
  }
  return clauses;
}

}  // namespace palmar::capture
