// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/groove.h"

#include <fmt/format.h>

#include "palmar/core/error.h"

namespace palmar::cad {

void GrooveEdit::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds) {
      throw UsageError(
          fmt::format("groove: {} is {:.4g} mm; {} is allowed", field, value, allowed));
    }
  };
  require(radius >= 0.5 && radius <= 200.0, "radius", radius, "0.5 to 200 mm");
  require(depth > 0.0 && depth <= radius, "depth", depth, "above 0, at most the radius,");
  require(rim >= 0.0 && rim <= 50.0, "rim", rim, "0 to 50 mm");
  require(smoothing >= 0.01 && smoothing <= 10.0, "smoothing", smoothing, "0.01 to 10 mm");
  const size_t least = is_closed ? 4 : 2;
  if (!ring_at && points.size() < least) {
    throw UsageError(fmt::format("groove: {} points along its line; {} or more are needed",
                                 points.size(), least));
  }
}

std::string GrooveEdit::title() const {
  return fmt::format("groove of {:.4g} mm radius, {:.4g} mm deep", radius, depth);
}

}  // namespace palmar::cad
