// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/proportion.h"

#include <cmath>
#include <string>

#include "palmar/core/error.h"
#include "palmar/statistics/distributions.h"

namespace palmar::statistics {

Proportion wilson_proportion(int count, int n, double level) {
  if (count < 0 || count > n) {
    throw UsageError("proportion: " + std::to_string(count) + " of " + std::to_string(n) +
                     "; 0 to all of them is allowed");
  }
  check_level(level);
  Proportion result{count, n, 0.0, {0.0, 1.0}};
  if (n == 0) return result;
  const double k = count;
  const double z = normal_quantile(1.0 - (1.0 - level) / 2.0);
  const double middle = k + 0.5 * z * z;
  const double half = z * std::sqrt(k * (n - k) / n + 0.25 * z * z);
  result.share = k / n;
  // Exactly 0 and 1 at the ends, where rounding would leave 1e-17.
  result.interval.low = count == 0 ? 0.0 : (middle - half) / (n + z * z);
  result.interval.high = count == n ? 1.0 : (middle + half) / (n + z * z);
  return result;
}

}  // namespace palmar::statistics
