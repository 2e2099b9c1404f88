// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/linear_program.h"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

constexpr double kTolerance = 1e-10;  // of reduced costs and pivots, data of order one
constexpr int kStalled = 20;          // steps without gain before Bland's rule

/// The program with one artificial variable per row behind the others.
class Simplex {
 public:
  Simplex(const Eigen::MatrixXd& A, const Eigen::VectorXd& b)
      : rows_(static_cast<int>(A.rows())), columns_(static_cast<int>(A.cols())), A_(A), b_(b) {
    for (int i = 0; i < rows_; ++i) {
      if (b_[i] >= 0.0) continue;  // artificial variables start at b >= 0
      A_.row(i) *= -1.0;
      b_[i] *= -1.0;
    }
    sign_ = Eigen::VectorXd::Ones(rows_);
    for (int i = 0; i < rows_; ++i) sign_[i] = b[i] < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < rows_; ++i) basis_.push_back(columns_ + i);
    in_basis_.assign(columns_ + rows_, 0);
    for (const int j : basis_) in_basis_[j] = 1;
  }

  /// Minimises cost . x; artificial variables cost `artificial` each. In phase 2 they must stay 0.
  ProgramStatus run(const Eigen::VectorXd& cost, double artificial, bool is_second) {
    const int most = 200 * (rows_ + columns_);
    int stalled = 0;
    for (; iterations_ < most; ++iterations_) {
      factor();
      Eigen::VectorXd of_basis(rows_);
      for (int i = 0; i < rows_; ++i) {
        of_basis[i] = basis_[i] < columns_ ? cost[basis_[i]] : artificial;
      }
      dual_ = lu_.transpose().solve(of_basis);
      const Eigen::VectorXd reduced = cost - A_.transpose() * dual_;
      const int entering = pick_entering(reduced, stalled > kStalled);
      if (entering < 0) return ProgramStatus::kOptimal;
      const Eigen::VectorXd step = lu_.solve(A_.col(entering));
      const int leaving = pick_leaving(step, is_second, stalled > kStalled);
      if (leaving < 0) return ProgramStatus::kUnbounded;
      stalled = value_[leaving] > kTolerance ? 0 : stalled + 1;
      in_basis_[basis_[leaving]] = 0;
      in_basis_[entering] = 1;
      basis_[leaving] = entering;
    }
    return ProgramStatus::kNotConverged;
  }

  double artificial_sum() {
    factor();
    double sum = 0.0;
    for (int i = 0; i < rows_; ++i) {
      if (basis_[i] >= columns_) sum += std::max(0.0, value_[i]);
    }
    return sum;
  }

  Eigen::VectorXd x() {
    factor();
    Eigen::VectorXd result = Eigen::VectorXd::Zero(columns_);
    for (int i = 0; i < rows_; ++i) {
      if (basis_[i] < columns_) result[basis_[i]] = std::max(0.0, value_[i]);
    }
    return result;
  }

  Eigen::VectorXd dual() const { return sign_.cwiseProduct(dual_); }
  int iterations() const { return iterations_; }

 private:
  void factor() {
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(rows_, rows_);
    for (int i = 0; i < rows_; ++i) {
      if (basis_[i] < columns_) {
        B.col(i) = A_.col(basis_[i]);
      } else {
        B(basis_[i] - columns_, i) = 1.0;
      }
    }
    lu_.compute(B);
    value_ = lu_.solve(b_);
  }

  int pick_entering(const Eigen::VectorXd& reduced, bool is_bland) const {
    int best = -1;
    double least = -kTolerance;
    for (int j = 0; j < columns_; ++j) {
      if (in_basis_[j] != 0 || reduced[j] >= least) continue;
      best = j;
      if (is_bland) return best;
      least = reduced[j];
    }
    return best;
  }

  /// Row of the basis that reaches 0 first. An artificial variable that is 0 already leaves in
  /// phase 2 whatever the sign of its step, as it must not grow.
  int pick_leaving(const Eigen::VectorXd& step, bool is_second, bool is_bland) const {
    int best = -1;
    double least = 0.0;
    for (int i = 0; i < rows_; ++i) {
      const bool is_pinned = is_second && basis_[i] >= columns_;
      if (is_pinned ? std::abs(step[i]) <= 1e-9 : step[i] <= 1e-9) continue;
      const double ratio = is_pinned ? 0.0 : std::max(0.0, value_[i]) / step[i];
      const bool is_tie = best >= 0 && ratio <= least + 1e-14;
      const bool is_better = best < 0 || ratio < least - 1e-14 ||
                             (is_tie && (is_bland ? basis_[i] < basis_[best]
                                                  : std::abs(step[i]) > std::abs(step[best])));
      if (!is_better) continue;
      best = i;
      least = ratio;
    }
    return best;
  }

  int rows_, columns_;
  Eigen::MatrixXd A_;
  Eigen::VectorXd b_, sign_, value_, dual_;
  std::vector<int> basis_;
  std::vector<char> in_basis_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  int iterations_ = 0;
};

}  // namespace

ProgramSolution solve_linear_program(const Eigen::VectorXd& c, const Eigen::MatrixXd& A,
                                     const Eigen::VectorXd& b) {
  if (A.rows() != b.size() || A.cols() != c.size() || A.rows() == 0) {
    throw UsageError("linear program: " + std::to_string(c.size()) + " costs and " +
                     std::to_string(b.size()) + " right-hand sides for a matrix of " +
                     std::to_string(A.rows()) + " x " + std::to_string(A.cols()));
  }
  if (!A.allFinite() || !b.allFinite() || !c.allFinite()) {
    throw UsageError("linear program: an entry is not finite");
  }
  ProgramSolution solution;
  Simplex simplex(A, b);
  const ProgramStatus first = simplex.run(Eigen::VectorXd::Zero(c.size()), 1.0, false);
  solution.iterations = simplex.iterations();
  if (first != ProgramStatus::kOptimal) return solution;
  constexpr double kFeasible = 1e-8;  // of the size of b
  if (simplex.artificial_sum() > kFeasible * std::max(1.0, b.cwiseAbs().maxCoeff())) {
    solution.status = ProgramStatus::kInfeasible;
    solution.dual = simplex.dual();
    return solution;
  }
  solution.status = simplex.run(c, 0.0, true);
  solution.iterations = simplex.iterations();
  solution.dual = simplex.dual();
  if (solution.status != ProgramStatus::kOptimal) return solution;
  solution.x = simplex.x();
  solution.value = c.dot(solution.x);
  solution.residual = (A * solution.x - b).cwiseAbs().maxCoeff();
  return solution;
}

}  // namespace palmar::grasp
