// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/packed_cholesky.h"

#include <algorithm>
#include <cmath>

namespace palmar::contact {

namespace {

/// block -= A B^T over `count` columns of two panels. Plain loops: sanitizer builds don't inline
/// Eigen's expressions, and this is where the time goes.
void subtract_product(const double* a, const double* b, int count, double (&block)[4][4]) {
  double sum[4][4];
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) sum[c][r] = block[c][r];
  }
  for (int k = 0; k < count; ++k, a += 4, b += 4) {
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) sum[c][r] -= a[r] * b[c];
    }
  }
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) block[c][r] = sum[c][r];
  }
}

}  // namespace

bool PackedCholesky::factor_panel(int i) {
  double* const rows = panel(i);
  for (int j = 0; j <= i; ++j) {
    const double* const above = panel(j);
    double block[4][4];  // by column
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) block[c][r] = rows[4 * (4 * j + c) + r];
    }
    subtract_product(rows, above, 4 * j, block);
    const double* const corner = above + 16 * j;
    for (int c = 0; c < 4; ++c) {
      for (int k = 0; k < c; ++k) {
        const double factor = i == j ? block[k][c] : corner[4 * k + c];
        for (int r = 0; r < 4; ++r) block[c][r] -= block[k][r] * factor;
      }
      if (i == j) {
        if (!(block[c][c] > 0.0)) return false;
        const double inverse = 1.0 / std::sqrt(block[c][c]);
        for (int r = 0; r < 4; ++r) block[c][r] *= inverse;
        block[c][c] = inverse;
      } else {
        for (int r = 0; r < 4; ++r) block[c][r] *= corner[4 * c + c];
      }
    }
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) rows[4 * (4 * j + c) + r] = block[c][r];
    }
  }
  return true;
}

bool PackedCholesky::factor(const Eigen::MatrixXd& R, const std::vector<int>& set) {
  const auto common = std::mismatch(set.begin(), set.end(), set_.begin(), set_.end());
  const int n = static_cast<int>(set.size());
  const int kept = static_cast<int>(common.first - set.begin()) / kPanel;
  const int panels = (n + kPanel - 1) / kPanel;
  set_ = set;
  packed_.resize(static_cast<std::size_t>(8) * panels * (panels + 1));
  for (int i = kept; i < panels; ++i) {
    double* const rows = panel(i);
    for (int r = 0; r < kPanel; ++r) {
      const int row = kPanel * i + r;
      for (int k = 0; k < kPanel * (i + 1); ++k) {
        // Beyond the end the unit matrix.
        rows[4 * k + r] = row < n && k < n ? R(set[k], set[row]) : (row == k ? 1.0 : 0.0);
      }
    }
    if (!factor_panel(i)) {
      set_.clear();
      return false;
    }
  }
  return true;
}

Eigen::VectorXd PackedCholesky::solve(const Eigen::VectorXd& b) const {
  const int n = static_cast<int>(set_.size());
  const int panels = (n + kPanel - 1) / kPanel;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kPanel) * panels);
  x.head(n) = b;
  for (int i = 0; i < panels; ++i) {
    const double* const rows = panel(i);
    double t[4];
    for (int r = 0; r < 4; ++r) t[r] = x[4 * i + r];
    for (int k = 0; k < 4 * i; ++k) {
      for (int r = 0; r < 4; ++r) t[r] -= rows[4 * k + r] * x[k];
    }
    const double* const corner = rows + 16 * i;
    for (int c = 0; c < 4; ++c) {
      x[4 * i + c] = t[c] * corner[4 * c + c];
      for (int r = c + 1; r < 4; ++r) t[r] -= corner[4 * c + r] * x[4 * i + c];
    }
  }
  for (int i = panels - 1; i >= 0; --i) {
    const double* const rows = panel(i);
    const double* const corner = rows + 16 * i;
    double t[4];
    for (int c = 3; c >= 0; --c) {
      t[c] = x[4 * i + c];
      for (int r = c + 1; r < 4; ++r) t[c] -= corner[4 * c + r] * t[r];
      t[c] *= corner[4 * c + c];
      x[4 * i + c] = t[c];
    }
    for (int k = 0; k < 4 * i; ++k) {
      x[k] -= rows[4 * k] * t[0] + rows[4 * k + 1] * t[1] + rows[4 * k + 2] * t[2] +
              rows[4 * k + 3] * t[3];
    }
  }
  return x.head(n);
}

}  // namespace palmar::contact
