// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/board_pattern.h"

#include <fmt/format.h>

#include "palmar/core/error.h"

namespace palmar::capture {

void BoardPattern::check() const {
  constexpr int kMost = 21;
  if (squares < 5 || squares > kMost || squares % 2 == 0) {
    throw UsageError(fmt::format(
        "board of {} squares along an edge; an odd number of 5 to 21 is allowed", squares));
  }
  if (!(square >= 5.0 && square <= 200.0)) {
    throw UsageError(fmt::format("board squares of {:g} mm; 5 to 200 mm is allowed", square));
  }
  if (!(marker >= 0.5 * square && marker <= 0.9 * square)) {
    throw UsageError(fmt::format(
        "board markers of {:g} mm; 0.5 to 0.9 of a square ({:g} mm) is allowed", marker, square));
  }
}

}  // namespace palmar::capture
