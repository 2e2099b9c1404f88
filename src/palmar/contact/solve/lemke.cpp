// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/lemke.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

/// Dictionary of s = d + R p + e z: each basic variable as an affine function of the nonbasic ones.
/// Variables are numbered s_0 ... s_m-1 (0 to m-1), p_0 ... p_m-1 (m to 2m-1), z (2m).
class Dictionary {
 public:
  explicit Dictionary(const ContactProblem& problem)
      : m_(static_cast<int>(problem.distance.size())),
        constant_(problem.distance),
        coefficient_(m_, m_ + 1),
        row_of_(2 * m_ + 1, -1),
        column_of_(2 * m_ + 1, -1),
        basic_(m_),
        nonbasic_(m_ + 1) {
    coefficient_.leftCols(m_) = problem.response;
    coefficient_.col(m_).setOnes();
    for (int i = 0; i < m_; ++i) {
      basic_[i] = i;
      row_of_[i] = i;
      nonbasic_[i] = m_ + i;
      column_of_[m_ + i] = i;
    }
    nonbasic_[m_] = 2 * m_;
    column_of_[2 * m_] = m_;
  }

  int artificial() const { return 2 * m_; }
  int complement(int variable) const { return variable < m_ ? variable + m_ : variable - m_; }
  int basic(int row) const { return basic_[row]; }
  bool is_basic(int variable) const { return row_of_[variable] >= 0; }
  double value(int variable) const { return is_basic(variable) ? constant_[row_of_[variable]] : 0; }

  /// Row of the initial pivot: the lexicographically smallest of (d_i, e_i).
  int first_row() const {
    int best = 0;
    for (int i = 1; i < m_; ++i) {
      // Among equal d the later unit vector is the smaller one.
      if (constant_[i] <= constant_[best]) best = i;
    }
    return best;
  }

  /// Row that blocks an increase of `entering`, or -1 if none does (a ray).
  int blocking_row(int entering, double tolerance) const {
    const int column = column_of_[entering];
    int best = -1;
    for (int i = 0; i < m_; ++i) {
      if (coefficient_(i, column) >= -tolerance) continue;
      if (best < 0 || is_smaller_ratio(i, best, column)) best = i;
    }
    return best;
  }

  void exchange(int row, int entering) {
    const int column = column_of_[entering];
    const double pivot = coefficient_(row, column);
    // entering = (leaving - constant - sum of the others) / pivot
    const Eigen::VectorXd entering_column = coefficient_.col(column);
    Eigen::RowVectorXd pivot_row = coefficient_.row(row) / -pivot;
    pivot_row[column] = 1.0 / pivot;
    const double pivot_constant = constant_[row] / -pivot;
    coefficient_.col(column).setZero();
    coefficient_.noalias() += entering_column * pivot_row;
    constant_ += entering_column * pivot_constant;
    coefficient_.row(row) = pivot_row;
    constant_[row] = pivot_constant;
    const int leaving = basic_[row];
    basic_[row] = entering;
    nonbasic_[column] = leaving;
    row_of_[entering] = row;
    row_of_[leaving] = -1;
    column_of_[leaving] = column;
    column_of_[entering] = -1;
  }

 private:
  /// Coefficient of the perturbation of d_k in basic row i.
  double perturbation(int i, int k) const {
    if (row_of_[k] >= 0) return row_of_[k] == i ? 1.0 : 0.0;
    return -coefficient_(i, column_of_[k]);
  }

  bool is_smaller_ratio(int i, int j, int column) const {
    const double ci = -coefficient_(i, column);
    const double cj = -coefficient_(j, column);
    const double a = constant_[i] / ci;
    const double b = constant_[j] / cj;
    const double rounding = 1e-13 * std::max(std::abs(a), std::abs(b));
    if (std::abs(a - b) > rounding) return a < b;
    // z leaves as soon as it may: that ends the method.
    if (basic_[i] == artificial()) return true;
    if (basic_[j] == artificial()) return false;
    for (int k = 0; k < m_; ++k) {
      const double x = perturbation(i, k) / ci;
      const double y = perturbation(j, k) / cj;
      if (std::abs(x - y) > 1e-13 * std::max(std::abs(x), std::abs(y))) return x < y;
    }
    return i < j;
  }

  int m_;
  Eigen::VectorXd constant_;
  Eigen::MatrixXd coefficient_;  ///< m x (m + 1)
  std::vector<int> row_of_;      ///< of a basic variable, else -1
  std::vector<int> column_of_;   ///< of a nonbasic variable, else -1
  std::vector<int> basic_;
  std::vector<int> nonbasic_;
};

}  // namespace

void LemkeOptions::check() const {
  if (max_pivots && *max_pivots < 1) {
    throw UsageError("max_pivots is " + std::to_string(*max_pivots) + "; 1 or more is required");
  }
  if (!(pivot_tolerance >= 0.0 && pivot_tolerance < 1e-3)) {
    throw UsageError("pivot_tolerance is " + std::to_string(pivot_tolerance) +
                     "; 0 or more and less than 0.001 is required");
  }
}

ContactSolution solve_contact_lemke(const ContactProblem& problem, const LemkeOptions& options) {
  problem.check();
  options.check();
  const int m = static_cast<int>(problem.distance.size());
  ContactSolution solution;
  solution.force = Eigen::VectorXd::Zero(m);
  if (m == 0 || problem.distance.minCoeff() >= 0.0) {
    solution.status = LcpStatus::kSolved;
    recompute_residual(problem, solution);
    return solution;
  }
  const int max_pivots = options.max_pivots.value_or(100 + 10 * m);
  const double tolerance =
      options.pivot_tolerance * std::max(1e-300, problem.response.cwiseAbs().maxCoeff());

  Dictionary dictionary(problem);
  int row = dictionary.first_row();
  int entering = dictionary.artificial();
  while (solution.pivots < max_pivots) {
    const int leaving = dictionary.basic(row);
    dictionary.exchange(row, entering);
    ++solution.pivots;
    if (leaving == dictionary.artificial()) {
      solution.status = LcpStatus::kSolved;
      break;
    }
    entering = dictionary.complement(leaving);
    row = dictionary.blocking_row(entering, tolerance);
    if (row < 0) {
      solution.status = LcpStatus::kRayTermination;
      break;
    }
  }
  if (solution.status == LcpStatus::kSolved) {
    for (int i = 0; i < m; ++i) solution.force[i] = std::max(0.0, dictionary.value(m + i));
  }
  recompute_residual(problem, solution);
  return solution;
}

}  // namespace palmar::contact
