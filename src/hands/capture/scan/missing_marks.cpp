// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/missing_marks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace palmar::capture {

std::string missing_creases_note(const std::vector<hand::Segment>& missing) {
  if (missing.empty()) return {};
  std::vector<std::string> names;
  for (const hand::Segment s : missing) {
    names.push_back(s == hand::Segment::kPalm ? "wrist" : std::string(name_of(s)));
  }
  return fmt::format("Creases not found, taken from the joints: {}.", fmt::join(names, ", "));
}

std::map<hand::Segment, int> advised_dots() {
  constexpr int kOnPhalanx = 3, kOnHand = 8;
  std::map<hand::Segment, int> advised;
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    advised[segment] = segment == hand::Segment::kPalm ? kOnHand : kOnPhalanx;
  }
  return advised;
}

std::string missing_dots_note(const std::string& scan, const std::map<hand::Segment, int>& found,
                              const std::map<hand::Segment, int>& expected) {
  std::vector<std::string> names;
  for (const auto& [segment, count] : expected) {
    const auto at = found.find(segment);
    const int here = at == found.end() ? 0 : at->second;
    if (here < count) names.push_back(fmt::format("{} ({} of {})", name_of(segment), here, count));
  }
  if (names.empty()) return {};
  return fmt::format(
      "{}: dots not found: {}. Where fewer than two are left, the joint follows the skin.", scan,
      fmt::join(names, ", "));
}

}  // namespace palmar::capture
