// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace palmar {
namespace {

using Words = std::array<std::uint32_t, 4>;

TEST(Philox, GivesThePublishedWords) {
  // Known-answer vectors that come with the paper's library (Random123, philox4x32, 10 rounds).
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  // Digits of pi.
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, WalksThroughTheCounterOfItsStream) {
  RandomStream stream(0x123456789abcdef0, 7);
  for (std::uint32_t block = 0; block < 3; ++block) {
    const Words words = philox({block, 0, 7, 0}, {0x9abcdef0, 0x12345678});
    EXPECT_EQ(stream.bits(), (std::uint64_t{words[1]} << 32U) | words[0]);
    EXPECT_EQ(stream.bits(), (std::uint64_t{words[3]} << 32U) | words[2]);
  }
}

TEST(RandomStream, StreamsAndSeedsDiffer) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (std::uint64_t stream = 0; stream < 20; ++stream) {
      first.insert(RandomStream(seed, stream).bits());
    }
  }
  EXPECT_EQ(first.size(), 400U);
}

TEST(RandomStream, UniformAndNormalHaveTheirMoments) {
  // Means and mean squares of n draws lie within 4.4 standard errors: false alarm once in 10^5.
  constexpr int kDraws = 200000;
  constexpr double kErrors = 4.4;
  double sum = 0.0, normals = 0.0, squares = 0.0, fourth = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    RandomStream stream(5, static_cast<std::uint64_t>(k));
    const double u = stream.uniform(), z = stream.normal();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    normals += z;
    squares += z * z;
    fourth += z * z * z * z;
  }
  const double root = std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(sum / kDraws, 0.5, kErrors * std::sqrt(1.0 / 12.0) / root);
  EXPECT_NEAR(normals / kDraws, 0.0, kErrors / root);
  EXPECT_NEAR(squares / kDraws, 1.0, kErrors * std::sqrt(2.0) / root);
  EXPECT_NEAR(fourth / kDraws, 3.0, kErrors * std::sqrt(96.0) / root);
}

TEST(RandomStream, EveryNumberBelowIsEquallyLikely) {
  // Pearson's statistic over 7 classes has 6 degrees of freedom: above 22.46 once in 1000.
  RandomStream stream(1, 2);
  std::vector<int> count(7, 0);
  for (int k = 0; k < 70000; ++k) ++count[stream.below(7)];
  double statistic = 0.0;
  for (const int n : count) statistic += (n - 10000.0) * (n - 10000.0) / 10000.0;
  EXPECT_LT(statistic, 22.46);
}

TEST(StandardNormalQuantile, MeetsTabulatedValues) {
  EXPECT_NEAR(standard_normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(standard_normal_quantile(0.05), -1.6448536269514722, 1e-14);
  EXPECT_EQ(standard_normal_quantile(0.5), 0.0);
  EXPECT_NEAR(standard_normal_quantile(1e-12), -7.034483825301131, 1e-12);
}

}  // namespace
}  // namespace palmar
