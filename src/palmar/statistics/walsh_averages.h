// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace palmar::statistics {

/// The k-th smallest (from 1) of the m (m + 1) / 2 averages (x_i + x_j) / 2, i <= j, of sorted
/// finite values; memory O(1), time O(m) per bit of a double. The average of 50 000 people is found
/// in milliseconds.
double walsh_average(std::span<const double> sorted, std::uint64_t k);

/// Median of the Walsh averages: the Hodges-Lehmann estimate (Hodges & Lehmann 1963).
double walsh_median(std::span<const double> sorted);

/// Number of subsets of {1 ... m} with sum s, for s = 0 ... m (m + 1) / 2: 2^m times the
/// distribution of the signed-rank statistic. Exact in double for m <= 52.
std::vector<double> signed_rank_counts(int m);

}  // namespace palmar::statistics
