// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/random.h"

#include <boost/math/special_functions/erf.hpp>
#include <numbers>

namespace palmar {
namespace {

constexpr std::uint32_t low(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
constexpr std::uint32_t high(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32U);
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t kM0 = 0xD2511F53, kM1 = 0xCD9E8D57;    // multipliers, table 2
  constexpr std::uint32_t kW0 = 0x9E3779B9U, kW1 = 0xBB67AE85U;  // Weyl sequence of the key
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t a = kM0 * counter[0], b = kM1 * counter[2];
    counter = {high(b) ^ counter[1] ^ key[0], low(b), high(a) ^ counter[3] ^ key[1], low(a)};
    key = {key[0] + kW0, key[1] + kW1};
  }
  return counter;
}

std::uint64_t RandomStream::bits() {
  if (used_ == 4) {
    words_ =
        philox({low(block_), high(block_), low(stream_), high(stream_)}, {low(seed_), high(seed_)});
    ++block_;
    used_ = 0;
  }
  const int at = used_;
  used_ += 2;
  return (std::uint64_t{words_[at + 1]} << 32U) | words_[at];
}

double RandomStream::uniform() {
  // 52 bits and a half: the largest value, 1 - 2^-53, still is a double below 1.
  return (static_cast<double>(bits() >> 12U) + 0.5) * 0x1p-52;
}

double RandomStream::normal() { return standard_normal_quantile(uniform()); }

std::uint64_t RandomStream::below(std::uint64_t n) {
  // Numbers beyond the last whole multiple of n would make the first ones likelier.
  const std::uint64_t over = (0 - n) % n;  // 2^64 mod n
  std::uint64_t value = bits();
  while (value < over) value = bits();
  return value % n;
}

double standard_normal_quantile(double p) {
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * p);
}

}  // namespace palmar
