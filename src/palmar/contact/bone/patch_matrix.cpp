// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/patch_matrix.h"

#include <algorithm>

namespace palmar::contact {

PatchMatrix::PatchMatrix(std::vector<int> patch, int count, std::vector<std::vector<int>> near)
    : patch_(std::move(patch)), rows_(count), near_(std::move(near)), block_(count) {
  place_.reserve(patch_.size());
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    std::vector<int>& rows = rows_[patch_[i]];
    place_.push_back(static_cast<int>(rows.size()));
    rows.push_back(static_cast<int>(i));
  }
  for (int I = 0; I < count; ++I) {
    for (const int J : near_[I]) {
      block_[I].emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_[I].size()),
                                                   static_cast<Eigen::Index>(rows_[J].size())));
    }
  }
}

PatchMatrix::PatchMatrix(int rows) : PatchMatrix(std::vector<int>(rows, 0), 1, {{0}}) {}

double PatchMatrix::operator()(int i, int j) const {
  if (patch_[i] < patch_[j]) std::swap(i, j);
  const std::vector<int>& near = near_[patch_[i]];
  const auto found = std::lower_bound(near.begin(), near.end(), patch_[j]);
  if (found == near.end() || *found != patch_[j]) return 0.0;
  const Eigen::MatrixXd& values = block_[patch_[i]][found - near.begin()];
  return values(place_[i], place_[j]);
}

Eigen::VectorXd PatchMatrix::operator*(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (int I = 0; I < patch_count(); ++I) {
    const std::vector<int>& rows = rows_[I];
    const Eigen::VectorXd own = x(rows);
    for (std::size_t k = 0; k < near_[I].size(); ++k) {
      const int J = near_[I][k];
      const std::vector<int>& columns = rows_[J];
      if (J == I) {
        y(rows) += block_[I][k] * own;
      } else {
        y(rows) += block_[I][k] * x(columns);
        y(columns) += block_[I][k].transpose() * own;
      }
    }
  }
  return y;
}

}  // namespace palmar::contact
