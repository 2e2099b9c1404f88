// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace palmar {

/// Ranks 1 to n in the order given; ties share their mean rank.
std::vector<double> mean_ranks(std::span<const double> values);

/// Spearman's rank correlation: Pearson's correlation of the ranks, -1 to 1; 0 if one of the two
/// doesn't vary. The figure of R's cor(x, y, method = "spearman"). Throws UsageError if the lengths
/// differ or there are fewer than 2 pairs. Source: Spearman 1904.
double rank_correlation(std::span<const double> x, std::span<const double> y);

}  // namespace palmar
