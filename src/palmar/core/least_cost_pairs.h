// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace palmar {

/// Pairs rows with columns one to one at least cost in all, where a row that stays without a column
/// costs `alone`. Returns the column of each row, -1 for none; no pair costs `alone` or more.
/// `cost`: rows of equal length, of finite numbers or up to 1e6 for what isn't allowed. Time goes
/// with rows^2 (rows + columns). Source: Kuhn 1955 (assignment problem); shortest augmenting paths.
std::vector<int> least_cost_pairs(const std::vector<std::vector<double>>& cost, double alone);

}  // namespace palmar
