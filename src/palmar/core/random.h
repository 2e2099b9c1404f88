// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace palmar {

/// Philox4x32-10: ten rounds of multiplication that turn a counter into four random words under a
/// key. No state: word n of any stream is known without those before it, so what hand k gets never
/// depends on threads or on other hands.
/// Source: Salmon, Moraes, Dror, Shaw 2011, Parallel random numbers: as easy as 1, 2, 3, section
/// 3.3 and table 2.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key);

/// The random numbers of one thing (a hand, a layer) of a run. Streams of one seed are independent
/// of each other, and so are equal streams of different seeds; each has 2^65 numbers.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

  /// 64 random bits.
  std::uint64_t bits();
  /// Uniform between 0 and 1, neither of them; 52 bits.
  double uniform();
  /// Standard normal, by the inverse of its distribution: one uniform number each.
  double normal();
  /// Uniform among 0 ... n - 1, n > 0, every one equally likely.
  std::uint64_t below(std::uint64_t n);

 private:
  std::uint64_t seed_, stream_;
  std::uint64_t block_ = 0;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 4;
};

/// z with P(Z <= z) = p of the standard normal distribution, 0 < p < 1.
double standard_normal_quantile(double p);

}  // namespace palmar
