// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/imaging/otsu.h"

#include <gtest/gtest.h>

namespace palmar {
namespace {

TEST(OtsuParting, LiesInTheMiddleOfTheGapBetweenTwoHeaps) {
  std::vector<double> histogram(20, 0.0);
  histogram[2] = 30.0;
  histogram[3] = 50.0;
  histogram[12] = 10.0;
  histogram[13] = 12.0;
  // Bins 4 to 11 are empty: bins 0 to 3 lie below any of 4 ... 12, whose middle is 8.
  EXPECT_DOUBLE_EQ(otsu_parting(histogram), 8.0);
}

TEST(OtsuParting, HasLeastVarianceWithinItsClasses) {
  const std::vector<double> histogram = {1, 5, 9, 6, 2, 1, 3, 7, 8, 4};
  const auto within = [&](std::size_t parting) {  // sum of squares about the classes' means
    double whole = 0.0;
    for (const auto& [from, to] :
         {std::pair{std::size_t{0}, parting}, {parting, histogram.size()}}) {
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
  const auto found = static_cast<std::size_t>(otsu_parting(histogram));
  for (std::size_t parting = 1; parting < histogram.size(); ++parting) {
    EXPECT_GE(within(parting), within(found) - 1e-9) << parting;
  }
}

TEST(OtsuParting, OfOneHeapOrNone) {
  EXPECT_DOUBLE_EQ(otsu_parting({0.0, 4.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(otsu_parting({}), 1.0);
}

}  // namespace
}  // namespace palmar
