// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/least_cost_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "palmar/core/random.h"

namespace palmar {
namespace {

TEST(LeastCostPairs, PrefersTheSumToTheBestSinglePair) {
  // The cheapest pair (0, 0) would leave 9 for row 1; 2 + 2 is less than 1 + 9.
  EXPECT_THAT(least_cost_pairs({{1.0, 2.0}, {2.0, 9.0}}, 100.0), testing::ElementsAre(1, 0));
}

TEST(LeastCostPairs, LeavesARowAloneWhereThatIsCheaper) {
  EXPECT_THAT(least_cost_pairs({{1.0}, {2.0}}, 5.0), testing::ElementsAre(0, -1));
  EXPECT_THAT(least_cost_pairs({{7.0}}, 5.0), testing::ElementsAre(-1));
  EXPECT_THAT(least_cost_pairs({}, 5.0), testing::IsEmpty());
  EXPECT_THAT(least_cost_pairs({{}, {}}, 5.0), testing::ElementsAre(-1, -1));
}

/// What a pairing costs; infinite if it uses a column twice.
double cost_of(const std::vector<std::vector<double>>& cost, const std::vector<int>& pair,
               double alone) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pair.size(); ++i) {
    if (pair[i] < 0) {
      sum += alone;
      continue;
    }
    if (std::count(pair.begin(), pair.end(), pair[i]) > 1) {
      return std::numeric_limits<double>::infinity();
    }
    sum += cost[i][pair[i]];
  }
  return sum;
}

TEST(LeastCostPairs, NoOtherPairingIsCheaper) {
  RandomStream random(5, 0);
  for (const auto& [rows, columns] : {std::pair{4, 4}, std::pair{5, 3}, std::pair{3, 6}}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::vector<std::vector<double>> cost(rows);
      for (auto& row : cost) {
        for (int c = 0; c < columns; ++c) row.push_back(10.0 * random.uniform());
      }
      constexpr double kAlone = 4.0;
      // All pairings: each row counts from -1 to the last column.
      std::vector<int> pair(rows, -1);
      double least = std::numeric_limits<double>::infinity();
      for (bool is_done = false; !is_done;) {
        least = std::min(least, cost_of(cost, pair, kAlone));
        is_done = true;
        for (int& one : pair) {
          if (++one < columns) {
            is_done = false;
            break;
          }
          one = -1;
        }
      }
      EXPECT_NEAR(cost_of(cost, least_cost_pairs(cost, kAlone), kAlone), least, 1e-9);
    }
  }
}

}  // namespace
}  // namespace palmar
