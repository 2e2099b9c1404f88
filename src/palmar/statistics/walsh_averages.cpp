// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/walsh_averages.h"

#include <bit>

namespace palmar::statistics {
namespace {

/// Integers in the order of the doubles, and back; -0 below 0.
std::uint64_t ordered(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

double from_ordered(std::uint64_t key) {
  constexpr std::uint64_t kSign = std::uint64_t{1} << 63;
  return std::bit_cast<double>((key & kSign) != 0 ? key & ~kSign : ~key);
}

double average(double a, double b) { return 0.5 * a + 0.5 * b; }

/// Averages that are at most t: for growing i, the last j falls.
std::uint64_t count_up_to(std::span<const double> x, double t) {
  std::uint64_t count = 0;
  std::size_t end = x.size();  // x[i], x[j] with j < end may still count
  for (std::size_t i = 0; i < x.size(); ++i) {
    while (end > i && average(x[i], x[end - 1]) > t) --end;
    if (end <= i) break;
    count += end - i;
  }
  return count;
}

}  // namespace

double walsh_average(std::span<const double> sorted, std::uint64_t k) {
  std::uint64_t low = ordered(sorted.front());
  std::uint64_t high = ordered(sorted.back());
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (count_up_to(sorted, from_ordered(middle)) >= k) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return from_ordered(low);
}

double walsh_median(std::span<const double> sorted) {
  const auto m = static_cast<std::uint64_t>(sorted.size());
  const std::uint64_t n = m * (m + 1) / 2;
  const double upper = walsh_average(sorted, n / 2 + 1);
  return n % 2 == 1 ? upper : 0.5 * (walsh_average(sorted, n / 2) + upper);
}

std::vector<double> signed_rank_counts(int m) {
  const auto last = static_cast<std::size_t>(m) * (m + 1) / 2;
  std::vector<double> count(last + 1, 0.0);
  count[0] = 1.0;
  for (std::size_t rank = 1; rank <= static_cast<std::size_t>(m); ++rank) {
    for (std::size_t s = rank * (rank + 1) / 2; s >= rank; --s) count[s] += count[s - rank];
  }
  return count;
}

}  // namespace palmar::statistics
