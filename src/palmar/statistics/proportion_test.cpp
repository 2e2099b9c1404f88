// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/proportion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"

namespace palmar::statistics {
namespace {

TEST(WilsonProportion, AgreesWithR) {
  // R 4.2: prop.test(k, n, correct = FALSE)$conf.int, printed with digits = 15
  const Proportion most = wilson_proportion(27, 30);
  EXPECT_NEAR(most.interval.low, 0.743789174208159, 1e-12);
  EXPECT_NEAR(most.interval.high, 0.965400111252666, 1e-12);
  const Proportion some = wilson_proportion(3, 1000, 0.99);
  EXPECT_NEAR(some.interval.low, 0.000758101231061468, 1e-12);
  EXPECT_NEAR(some.interval.high, 0.011793516682924918, 1e-12);
}

TEST(WilsonProportion, EndsAreWhereTheScoreTestStops) {
  // Each end p solves |k/n - p| = z sqrt(p (1 - p) / n).
  const double z = 1.959963984540054;
  for (const int k : {1, 7, 19}) {
    const Proportion one = wilson_proportion(k, 20);
    for (const double p : {one.interval.low, one.interval.high}) {
      EXPECT_NEAR(std::abs(k / 20.0 - p), z * std::sqrt(p * (1.0 - p) / 20.0), 1e-12) << k;
    }
  }
}

TEST(WilsonProportion, NobodyAndEverybody) {
  const double z2 = 1.959963984540054 * 1.959963984540054;
  const Proportion none = wilson_proportion(0, 30);
  EXPECT_EQ(none.interval.low, 0.0);
  EXPECT_NEAR(none.interval.high, z2 / (30 + z2), 1e-12);
  const Proportion all = wilson_proportion(30, 30);
  EXPECT_EQ(all.share, 1.0);
  EXPECT_EQ(all.interval.high, 1.0);
  EXPECT_NEAR(all.interval.low, 30 / (30 + z2), 1e-12);
  const Proportion unknown = wilson_proportion(0, 0);
  EXPECT_EQ(unknown.interval.low, 0.0);
  EXPECT_EQ(unknown.interval.high, 1.0);
}

TEST(WilsonProportion, RefusesMoreThanAll) {
  try {
    wilson_proportion(4, 3);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "proportion: 4 of 3; 0 to all of them is allowed");
  }
}

}  // namespace
}  // namespace palmar::statistics
