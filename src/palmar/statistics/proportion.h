// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/statistics/summary.h"

namespace palmar::statistics {

/// A share of counted people, with the interval that holds the share of the population they were
/// drawn from:
///
///     (k + z^2/2 -/+ z sqrt(k (n - k)/n + z^2/4)) / (n + z^2),   z = normal quantile.
///
/// Never outside 0 to 1 and not empty at k = 0 or n, unlike the textbook's share -/+ z sd.
/// Source: Wilson 1927; R's prop.test(k, n, correct = FALSE).
struct Proportion {
  int count = 0;       ///< k
  int n = 0;           ///< of so many
  double share = 0.0;  ///< k / n; 0 of nobody
  Interval interval{0.0, 1.0};
};

/// Throws UsageError unless 0 <= count <= n and 0 < level < 1.
Proportion wilson_proportion(int count, int n, double level = 0.95);

}  // namespace palmar::statistics
