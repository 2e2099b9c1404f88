// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::statistics {

/// Equal to R's figure to 1e-9 of it; both compute in double, by different ways.
inline void expect_as_in_r(double value, double in_r, const char* what) {
  EXPECT_NEAR(value, in_r, 1e-9 * std::abs(in_r)) << what;
}

/// { f(1), ..., f(n) }.
inline std::vector<double> series(int n, const std::function<double(double)>& f) {
  std::vector<double> values;
  for (int i = 1; i <= n; ++i) values.push_back(f(i));
  return values;
}

/// Message of the UsageError that a call ends with; "" if it doesn't.
inline std::string usage_error(const std::function<void()>& call) {
  try {
    call();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

// R's `cars` (Ezekiel 1930): speed, mph, and stopping distance, ft.
inline const std::vector<double> kCarSpeed{4,  4,  7,  7,  8,  9,  10, 10, 10, 11, 11, 12, 12,
                                           12, 12, 13, 13, 13, 13, 14, 14, 14, 14, 15, 15, 15,
                                           16, 16, 17, 17, 17, 18, 18, 18, 18, 19, 19, 19, 20,
                                           20, 20, 20, 20, 22, 23, 24, 24, 24, 24, 25};
inline const std::vector<double> kCarDistance{2,  10, 4,  22, 16, 10, 18, 26, 34, 17,  28, 14, 20,
                                              24, 28, 26, 34, 34, 46, 26, 36, 60, 80,  20, 26, 54,
                                              32, 40, 32, 40, 50, 42, 56, 76, 84, 36,  46, 68, 32,
                                              48, 52, 56, 64, 66, 54, 70, 92, 93, 120, 85};

}  // namespace palmar::statistics
