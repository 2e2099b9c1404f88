// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palmar::contact {

/// Cholesky factor of principal blocks of one symmetric matrix, for the small blocks (20 to 300) of
/// block pivoting: rows that a block shares at its front with the block before are kept. Rows lie
/// in panels of four, so that the inner loop runs along memory.
class PackedCholesky {
 public:
  /// R = L L^T of R(set, set). Returns false if that block is not positive definite. Reads the
  /// columns in `set` of the whole matrix; the matrix must be the same in every call.
  bool factor(const Eigen::MatrixXd& R, const std::vector<int>& set);

  /// x of R(set, set) x = b, for the set factored last; b has one entry per entry of the set.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  static constexpr int kPanel = 4;
  double* panel(int i) { return packed_.data() + 8 * static_cast<std::ptrdiff_t>(i) * (i + 1); }
  const double* panel(int i) const {
    return packed_.data() + 8 * static_cast<std::ptrdiff_t>(i) * (i + 1);
  }
  bool factor_panel(int i);

  std::vector<int> set_;
  std::vector<double> packed_;  ///< L(4 i + r, k) at panel(i)[4 k + r]; the diagonal is inverted
};

}  // namespace palmar::contact
