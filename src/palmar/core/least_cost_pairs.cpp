// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/least_cost_pairs.h"

#include <algorithm>
#include <limits>

namespace palmar {
namespace {}  // namespace

std::vector<int> least_cost_pairs(const std::vector<std::vector<double>>& cost, double alone) {
  const int rows = static_cast<int>(cost.size());
  const int real = rows > 0 ? static_cast<int>(cost.front().size()) : 0;
  const int columns = real + rows;  // one more column per row, to stay alone in
  const auto cost_at = [&](int row, int column) {
    if (column < real) return std::min(cost[row][column], 1e6);
    return column - real == row ? alone : 1e6;
  };
  // Shortest augmenting paths with potentials, row by row (1-based; column 0 is the start).
  std::vector<double> u(static_cast<std::size_t>(rows) + 1, 0.0),
      v(static_cast<std::size_t>(columns) + 1, 0.0);
  std::vector<int> row_of(static_cast<std::size_t>(columns) + 1, 0),
      before(static_cast<std::size_t>(columns) + 1, 0);
  for (int row = 1; row <= rows; ++row) {
    row_of[0] = row;
    int column = 0;
    std::vector<double> least(static_cast<std::size_t>(columns) + 1,
                              std::numeric_limits<double>::infinity());
    std::vector<char> is_used(static_cast<std::size_t>(columns) + 1, 0);
    do {
      is_used[column] = 1;
      const int from = row_of[column];
      double delta = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int c = 1; c <= columns; ++c) {
        if (is_used[c] != 0) continue;
        const double reduced = cost_at(from - 1, c - 1) - u[from] - v[c];
        if (reduced < least[c]) {
          least[c] = reduced;
          before[c] = column;
        }
        if (least[c] < delta) {
          delta = least[c];
          next = c;
        }
      }
      for (int c = 0; c <= columns; ++c) {
        if (is_used[c] != 0) {
          u[row_of[c]] += delta;
          v[c] -= delta;
        } else {
          least[c] -= delta;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    do {
      const int previous = before[column];
      row_of[column] = row_of[previous];
      column = previous;
    } while (column != 0);
  }
  std::vector<int> pair(rows, -1);
  for (int c = 1; c <= real; ++c) {
    const int row = row_of[c];
    if (row > 0 && cost_at(row - 1, c - 1) < alone) pair[row - 1] = c - 1;
  }
  return pair;
}

}  // namespace palmar
