// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace palmar::grasp {

/// Sorts by cost, smallest first; items whose costs follow each other by less than `tie` stay in
/// the order in which they came. A symmetric product has places of equal cost, which rounding would
/// order otherwise once it is turned.
template <class Item, class Cost>
void sort_by_cost(std::vector<Item>& items, double tie, const Cost& cost) {
  std::vector<std::pair<double, std::size_t>> order(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = {cost(items[i]), i};
  std::sort(order.begin(), order.end());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && order[end].first - order[end - 1].first < tie) ++end;
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end),
              [](const auto& a, const auto& b) { return a.second < b.second; });
    begin = end;
  }
  std::vector<Item> sorted;
  sorted.reserve(items.size());
  for (const auto& [value, index] : order) sorted.push_back(std::move(items[index]));
  items = std::move(sorted);
}

/// Ties of costs that only rounding tells apart, and of those at the end of an iteration.
inline constexpr double kRoundedTie = 1e-7;
inline constexpr double kIteratedTie = 1e-3;

}  // namespace palmar::grasp
