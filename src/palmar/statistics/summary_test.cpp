// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "palmar/statistics/statistics_test_data.h"

namespace palmar::statistics {
namespace {

using testing::HasSubstr;

// R 4.2.2, tests/r/summary.R: mean, sd, sd / sqrt(n), t.test()$conf.int, quantile(), G1, G2.
TEST(Summary, EqualsR) {
  const Summary s = summarise(kCarSpeed);
  EXPECT_EQ(s.n, 50);
  expect_as_in_r(s.mean, 15.4, "mean");
  expect_as_in_r(s.sd, 5.2876444352347844, "sd");
  expect_as_in_r(s.standard_error, 0.74778584733156561, "standard error");
  expect_as_in_r(s.mean_interval->low, 13.897268078526778, "low");
  expect_as_in_r(s.mean_interval->high, 16.902731921473222, "high");
  EXPECT_EQ(s.min, 4.0);
  EXPECT_EQ(s.lower_quartile, 12.0);
  EXPECT_EQ(s.median, 15.0);
  EXPECT_EQ(s.upper_quartile, 19.0);
  EXPECT_EQ(s.max, 25.0);
  expect_as_in_r(*s.skewness, -0.11750986144663396, "skewness");
  expect_as_in_r(*s.excess_kurtosis, -0.50899442040576148, "kurtosis");
  const Summary d = summarise(kCarDistance, 0.99);
  expect_as_in_r(d.mean_interval->low, 33.213342982070508, "low, 99 %");
  expect_as_in_r(d.mean_interval->high, 52.746657017929486, "high, 99 %");
  expect_as_in_r(*d.skewness, 0.80689496016742157, "skewness");
  expect_as_in_r(*d.excess_kurtosis, 0.40505258167957653, "kurtosis");
}

// R 4.2.2, tests/r/summary.R: quantile(), type 7.
TEST(Quantile, EqualsR) {
  std::vector<double> sorted = kCarDistance;
  std::sort(sorted.begin(), sorted.end());
  expect_as_in_r(quantile(sorted, 0.01), 2.98, "P1");
  expect_as_in_r(quantile(sorted, 0.05), 10.0, "P5");
  expect_as_in_r(quantile(sorted, 0.95), 88.84999999999998, "P95");
  expect_as_in_r(quantile(sorted, 0.99), 106.76999999999995, "P99");
  EXPECT_EQ(quantile(sorted, 0.0), 2.0);
  EXPECT_EQ(quantile(sorted, 1.0), 120.0);
}

TEST(Summary, FarFromZeroKeepsItsDigits) {
  // Spread of 1 about 1e9: sums of squares without centring would lose all digits.
  const Summary s = summarise(std::vector<double>{1e9 - 1.0, 1e9, 1e9 + 1.0});
  EXPECT_EQ(s.mean, 1e9);
  EXPECT_DOUBLE_EQ(s.sd, 1.0);
  EXPECT_NEAR(*s.skewness, 0.0, 1e-12);
}

TEST(Summary, WhatFewOrEqualValuesCannotDetermineIsMissing) {
  const Summary one = summarise(std::vector<double>{190.0});
  EXPECT_EQ(one.mean, 190.0);
  EXPECT_EQ(one.sd, 0.0);
  EXPECT_FALSE(one.mean_interval);
  EXPECT_FALSE(one.skewness);
  const Summary two = summarise(std::vector<double>{180.0, 190.0});
  EXPECT_TRUE(two.mean_interval);
  EXPECT_FALSE(two.skewness);
  const Summary equal = summarise(std::vector<double>(9, 0.1));
  EXPECT_NEAR(equal.sd, 0.0, 1e-16);
  EXPECT_FALSE(equal.skewness);
  EXPECT_FALSE(equal.excess_kurtosis);
}

TEST(Summary, BadInputIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(usage_error([] { summarise({}); }), HasSubstr("0 values; at least 1 is needed"));
  EXPECT_THAT(usage_error([&] {
                summarise(std::vector<double>{1.0, nan});
              }),
              HasSubstr("value 2 is not a finite number"));
  EXPECT_THAT(usage_error([&] {
                summarise(std::vector<double>{1.0, 2.0}, 95.0);
              }),
              HasSubstr("confidence level 95.0"));
  EXPECT_THAT(usage_error([] { quantile({}, 0.5); }), HasSubstr("at least one is needed"));
  EXPECT_THAT(usage_error([] { quantile(std::vector<double>{1.0}, 5.0); }),
              HasSubstr("0 to 1 is allowed"));
}

}  // namespace
}  // namespace palmar::statistics
