// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>
#include <vector>

namespace palmar::product {

/// Which nodes of a graph are connected by the lines known so far.
class NodeTree {
 public:
  explicit NodeTree(int nodes) : above_(nodes) { std::iota(above_.begin(), above_.end(), 0); }

  /// Adds a line; whether its nodes were connected before.
  bool join(int a, int b) {
    const int root_a = root(a), root_b = root(b);
    above_[root_a] = root_b;
    return root_a == root_b;
  }

  bool are_joined(int a, int b) { return root(a) == root(b); }

 private:
  int root(int n) {
    while (above_[n] != n) n = above_[n] = above_[above_[n]];
    return n;
  }

  std::vector<int> above_;
};

}  // namespace palmar::product
