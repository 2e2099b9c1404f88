// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palmar::statistics {
namespace {

// d where R's pt(28.368, 19, ncp = d) is 0.025, divided by sqrt(20): 8.3851.
TEST(Noncentrality, EqualsRWhereTheSeriesOfBoostEnd) {
  EXPECT_NEAR(noncentrality_at(28.368, 19.0, 0.025) / std::sqrt(20.0), 8.3851, 5e-5);
}

// Far out, T / d is sqrt(df / chi2): d = t sqrt(chi2_p / df). Quantiles of chi2 from tables
// (Abramowitz & Stegun 1964, table 26.8): 45.7223 and 16.0471 for 29 degrees of freedom, 7.37776
// and 0.0506356 for 2.
TEST(Noncentrality, FollowsChiSquaredFarOut) {
  EXPECT_NEAR(noncentrality_at(1e9, 29.0, 0.025), 1e9 * std::sqrt(45.7223 / 29.0), 1e4);
  EXPECT_NEAR(noncentrality_at(1e9, 29.0, 0.975), 1e9 * std::sqrt(16.0471 / 29.0), 1e4);
  EXPECT_NEAR(noncentrality_at(1e9, 2.0, 0.025), 1e9 * std::sqrt(7.37776 / 2.0), 1e4);
  EXPECT_NEAR(noncentrality_at(1e9, 2.0, 0.975), 1e9 * std::sqrt(0.0506356 / 2.0), 1e4);
}

TEST(Noncentrality, IsThatOfTheNormalDistributionAtZero) {
  EXPECT_NEAR(noncentrality_at(0.0, 7.0, 0.025), 1.959963985, 1e-9);
}

TEST(Noncentrality, TurnsItsSignWithT) {
  for (const double t : {0.3, 4.0, 60.0}) {
    EXPECT_NEAR(noncentrality_at(-t, 11.0, 0.975), -noncentrality_at(t, 11.0, 0.025), 1e-9 * t);
  }
}

}  // namespace
}  // namespace palmar::statistics
