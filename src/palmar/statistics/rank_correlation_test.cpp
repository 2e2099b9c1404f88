// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/rank_correlation.h"

#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar {
namespace {

TEST(RankCorrelation, AgreesWithRWithTies) {
  // R 4.2: cor(x, y, method = "spearman"), digits = 15
  const std::vector<double> x = {3.1, 2.0, 5.5, 2.0, 7.25, 6.0, 5.5, 1.0};
  const std::vector<double> y = {10, 12, 9, 11, 4, 4, 4, 20};
  EXPECT_NEAR(rank_correlation(x, y), -0.95068973677523, 1e-12);
}

TEST(RankCorrelation, AnyRisingFunctionGivesOne) {
  const std::vector<double> x = {0.1, 4.0, 2.0, 1e6};
  const std::vector<double> y = {-5.0, 3.0, 2.9, 3.1};
  EXPECT_DOUBLE_EQ(rank_correlation(x, y), 1.0);
  EXPECT_EQ(rank_correlation(x, std::vector<double>(4, 2.0)), 0.0);
}

TEST(MeanRanks, TiesShareTheirMeanRank) {
  EXPECT_EQ(mean_ranks(std::vector<double>{5, 1, 5, 7}), (std::vector<double>{2.5, 1, 2.5, 4}));
}

TEST(RankCorrelation, NeedsPairs) {
  try {
    rank_correlation(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "rank correlation: 3 and 2 values; pairs are required");
  }
}

}  // namespace
}  // namespace palmar
