// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace palmar::contact {

/// A sparse matrix, row by row: entries begin[i] to begin[i + 1] - 1.
struct SparseRows {
  std::vector<std::size_t> begin{0};
  std::vector<int> column;  ///< ascending within a row
  std::vector<float> value;

  std::size_t size() const { return begin.size() - 1; }
};

}  // namespace palmar::contact
