// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/otsu.h"

#include <gtest/gtest.h>

namespace palmar::imaging {
namespace {

TEST(OtsuThreshold, LiesInTheMiddleOfTheGapBetweenTwoHeaps) {
  std::vector<double> histogram(20, 0.0);
  histogram[2] = 30.0;
  histogram[3] = 50.0;
  histogram[12] = 10.0;
  histogram[13] = 12.0;
  // Bins 4 to 11 are empty: bins 0 to 3 lie below any of 4 ... 12, whose middle is 8.
  EXPECT_DOUBLE_EQ(otsu_threshold(histogram), 8.0);
}

TEST(OtsuThreshold, HasLeastVarianceWithinItsClasses) {
  const std::vector<double> histogram = {1, 5, 9, 6, 2, 1, 3, 7, 8, 4};
  const auto within = [&](std::size_t threshold) {  // sum of squares about the classes' means
    double whole = 0.0;
    for (const auto& [from, to] :
         {std::pair{std::size_t{0}, threshold}, {threshold, histogram.size()}}) {
      double n = 0.0, sum = 0.0, square = 0.0;
      for (std::size_t b = from; b < to; ++b) {
        const auto x = static_cast<double>(b);
        n += histogram[b];
        sum += histogram[b] * x;
        square += histogram[b] * x * x;
      }
      whole += square - sum * sum / n;
    }
    return whole;
  };
  const auto found = static_cast<std::size_t>(otsu_threshold(histogram));
  for (std::size_t threshold = 1; threshold < histogram.size(); ++threshold) {
    EXPECT_GE(within(threshold), within(found) - 1e-9) << threshold;
  }
}

TEST(OtsuThreshold, OfOneHeapOrNone) {
  EXPECT_DOUBLE_EQ(otsu_threshold({0.0, 4.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(otsu_threshold({}), 1.0);
}

}  // namespace
}  // namespace palmar::imaging
