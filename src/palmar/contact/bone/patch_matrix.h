// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace palmar::contact {

/// Symmetric matrix whose rows are grouped in patches, with a dense block for each pair of patches
/// that are near each other; zero elsewhere. Of (I, J) and (J, I) only that with I >= J is kept, so
/// that it is symmetric to the last bit.
class PatchMatrix {
 public:
  /// `patch` of each row, 0 to count - 1; `near[I]`: the patches J <= I that have a block with I,
  /// ascending, I itself last. Zero at first.
  PatchMatrix(std::vector<int> patch, int count, std::vector<std::vector<int>> near);
  /// One patch: a dense matrix.
  explicit PatchMatrix(int rows);

  int size() const { return static_cast<int>(patch_.size()); }
  int patch_count() const { return static_cast<int>(rows_.size()); }
  int patch_of(int row) const { return patch_[row]; }
  int place_of(int row) const { return place_[row]; }
  const std::vector<int>& rows_of(int patch) const { return rows_[patch]; }
  const std::vector<int>& near(int patch) const { return near_[patch]; }

  /// Rows of patch I, columns of near(I)[k]. The block of a patch with itself is kept in full;
  /// whoever writes it keeps it symmetric.
  Eigen::MatrixXd& block(int I, std::size_t k) { return block_[I][k]; }
  const Eigen::MatrixXd& block(int I, std::size_t k) const { return block_[I][k]; }

  double operator()(int i, int j) const;
  /// y = A x.
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;

 private:
  std::vector<int> patch_, place_;
  std::vector<std::vector<int>> rows_, near_;
  std::vector<std::vector<Eigen::MatrixXd>> block_;
};

}  // namespace palmar::contact
