// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/marker_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/random.h"

namespace palmar::capture {
namespace {

Vec3 somewhere(RandomStream& random, double size) {
  return size * Vec3(random.uniform(), random.uniform(), random.uniform());
}

// Cost of the best pairing, found by trying all.
double least_cost(const std::vector<Vec3>& expected, const std::vector<Vec3>& found, double gate) {
  std::vector<int> order(found.size());
  std::iota(order.begin(), order.end(), 0);
  double best = std::numeric_limits<double>::max();
  do {
    double cost = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double d = (expected[i] - found[order[i]]).squaredNorm();
      cost += std::min(d, gate * gate);
    }
    best = std::min(best, cost);
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(MarkerMatching, AssignsAsTryingEverythingDoes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, 0);
    std::vector<Vec3> expected, found;
    for (int k = 0; k < 6; ++k) {
      expected.push_back(somewhere(random, 20.0));
      found.push_back(somewhere(random, 20.0));
    }
    constexpr double kGate = 9.0;
    const auto match = assign_points(expected, found, kGate);
    double cost = 0.0;
    std::vector<int> used;
    for (std::size_t i = 0; i < match.size(); ++i) {
      if (!match[i]) {
        cost += kGate * kGate;
        continue;
      }
      used.push_back(*match[i]);
      cost += (expected[i] - found[*match[i]]).squaredNorm();
    }
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::adjacent_find(used.begin(), used.end()), used.end()) << "seed " << seed;
    EXPECT_NEAR(cost, least_cost(expected, found, kGate), 1e-9) << "seed " << seed;
  }
}

// A dozen markers 12 mm apart that all move by more than half of that, some lost, some false.
TEST(MarkerMatching, FindsMarkersThatMoveTogetherFartherThanTheyStandApart) {
  std::vector<Vec3> expected, found;
  std::vector<int> truth;
  RandomStream random(7, 0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Vec3 p(12.0 * column, 12.0 * row, 0.02 * (row * row + column));
      const Vec3 moved = p + Vec3(7.0 + 0.03 * p.y(), 2.0 - 0.04 * p.x(), -1.0);
      expected.push_back(p);
      const bool is_lost = (row == 0 && column == 2) || (row == 2 && column == 1);
      truth.push_back(is_lost ? -1 : static_cast<int>(found.size()));
      if (!is_lost) found.push_back(moved + 0.3 * (somewhere(random, 2.0) - Vec3::Ones()));
    }
  }
  found.emplace_back(60.0, 5.0, 3.0);  // no markers
  found.emplace_back(-15.0, 40.0, 0.0);
  const auto match = match_markers(expected, found);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_EQ(match[i].value_or(-1), truth[i]) << i;
}

TEST(MarkerMatching, TakesNoPointsAtAll) {
  EXPECT_TRUE(match_markers({}, {Vec3::Zero()}).empty());
  const auto match = match_markers({Vec3::Zero(), Vec3::UnitX()}, {});
  ASSERT_EQ(match.size(), 2U);
  EXPECT_FALSE(match[0] || match[1]);
}

TEST(MarkerMatching, NamesTheOptionThatIsWrong) {
  MarkerMatchOptions options;
  options.last_gate = 20.0;
  try {
    match_markers({}, {}, options);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "matching of markers: last_gate is 20 mm; 0.1 to 16 is allowed");
  }
}

}  // namespace
}  // namespace palmar::capture
