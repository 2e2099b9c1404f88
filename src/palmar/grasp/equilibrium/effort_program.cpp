// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/effort_program.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace palmar::grasp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostIterations = 60;
constexpr double kTolerance = 1e-9;  // of residuals and complementarity, over their scale
constexpr double kToBoundary = 0.995;

/// Largest step, at most 1, that keeps v + step dv >= 0.
double largest_step(const VectorXd& v, const VectorXd& dv) {
  double step = 1.0;
  for (Index i = 0; i < v.size(); ++i) {
    if (dv[i] < 0.0) step = std::min(step, -v[i] / dv[i]);
  }
  return step;
}

/// z = (a, s+, s-) >= 0 with a <= 1; x free.
class Method {
 public:
  explicit Method(const EffortProgram& program)
      : p_(program),
        muscles_(program.muscles.cols()),
        rows_(program.required.size()),
        size_(muscles_ + 2 * rows_),
        all_(rows_, size_),
        cost_(VectorXd::Zero(size_)) {
    // Rows in units of their price, so that what is missing costs 1 per unit everywhere.
    all_.leftCols(muscles_) = p_.price.asDiagonal() * p_.muscles;
    all_.middleCols(muscles_, rows_).setIdentity();
    all_.rightCols(rows_) = -MatrixXd::Identity(rows_, rows_);
    motion_ = p_.price.asDiagonal() * p_.motion;
    required_ = p_.price.asDiagonal() * p_.required;
    cost_.tail(2 * rows_).setOnes();
    if (p_.motion.cols() > 0) hessian_.compute(p_.hessian);
    z_ = VectorXd::Constant(size_, 0.5);
    x_ = VectorXd::Zero(p_.motion.cols());
    y_ = VectorXd::Zero(rows_);
    lower_ = VectorXd::Constant(size_, 1.0);
    upper_ = VectorXd::Constant(muscles_, 1.0);
    scale_ = 1.0 + required_.lpNorm<Eigen::Infinity>();
    z_.tail(2 * rows_).setConstant(std::max(0.5, 0.5 * required_.lpNorm<Eigen::Infinity>()));
  }

  EffortSolution run() {
    EffortSolution result;
    for (; result.iterations < kMostIterations; ++result.iterations) {
      if (is_there()) {
        result.has_converged = true;
        break;
      }
      if (!take_step()) break;
    }
    result.activation = z_.head(muscles_).cwiseMax(0.0).cwiseMin(1.0);
    result.motion = x_;
    result.missing = (z_.segment(muscles_, rows_) - z_.tail(rows_)).cwiseQuotient(p_.price);
    result.multiplier = p_.price.asDiagonal() * y_;
    result.value = result.activation.array().cube().sum() + p_.price.dot(result.missing.cwiseAbs());
    if (x_.size() > 0) result.value += p_.gradient.dot(x_) + 0.5 * x_.dot(p_.hessian * x_);
    return result;
  }

 private:
  VectorXd slope() const {  // of the costs of z
    VectorXd g = cost_;
    g.head(muscles_).array() = 3.0 * z_.head(muscles_).array().square();
    return g;
  }
  VectorXd dual_residual() const {
    VectorXd r = slope() - all_.transpose() * y_ - lower_;
    r.head(muscles_) += upper_;
    return r;
  }
  VectorXd motion_residual() const {
    if (x_.size() == 0) return x_;
    return p_.hessian * x_ + p_.gradient - motion_.transpose() * y_;
  }
  VectorXd primal_residual() const {
    VectorXd r = all_ * z_ - required_;
    if (x_.size() > 0) r += motion_ * x_;
    return r;
  }
  VectorXd room() const { return VectorXd::Ones(muscles_) - z_.head(muscles_); }
  double gap() const {
    return (z_.dot(lower_) + room().dot(upper_)) / static_cast<double>(size_ + muscles_);
  }
  bool is_there() const {
    double dual = dual_residual().lpNorm<Eigen::Infinity>();
    if (x_.size() > 0) {
      dual = std::max(dual, motion_residual()
                                .cwiseQuotient(p_.hessian.diagonal().cwiseSqrt())
                                .lpNorm<Eigen::Infinity>());
    }
    return primal_residual().lpNorm<Eigen::Infinity>() < kTolerance * scale_ && dual < kTolerance &&
           gap() < kTolerance;
  }

  bool take_step() {
    const VectorXd r = room();
    VectorXd diagonal = lower_.cwiseQuotient(z_);
    diagonal.head(muscles_) += 6.0 * z_.head(muscles_) + upper_.cwiseQuotient(r);
    const VectorXd inverse = diagonal.cwiseInverse();
    MatrixXd normal = all_ * inverse.asDiagonal() * all_.transpose();
    MatrixXd followed;  // H^-1 D^T
    if (x_.size() > 0) {
      followed = hessian_.solve(motion_.transpose());
      normal += motion_ * followed;
    }
    const Eigen::LDLT<MatrixXd> factor(normal);
    const VectorXd rd = dual_residual(), rm = motion_residual(), rp = primal_residual();

    struct Way {
      VectorXd z, x, y, lower, upper;
    };
    const auto direction = [&](const VectorXd& target_z, const VectorXd& target_r) {
      Way d;
      VectorXd right = -rd + target_z.cwiseQuotient(z_) - lower_;
      right.head(muscles_) -= target_r.cwiseQuotient(r) - upper_;
      VectorXd y = -rp - all_ * inverse.cwiseProduct(right);
      if (x_.size() > 0) y += followed.transpose() * rm;
      d.y = factor.solve(y);
      d.z = inverse.cwiseProduct(right + all_.transpose() * d.y);
      if (x_.size() > 0) d.x = hessian_.solve(motion_.transpose() * d.y - rm);
      d.lower = (target_z - lower_.cwiseProduct(d.z)).cwiseQuotient(z_) - lower_;
      d.upper = (target_r + upper_.cwiseProduct(d.z.head(muscles_))).cwiseQuotient(r) - upper_;
      return d;
    };
    const auto length = [&](const Way& d) {
      return std::min({largest_step(z_, d.z), largest_step(r, -d.z.head(muscles_)),
                       largest_step(lower_, d.lower), largest_step(upper_, d.upper)});
    };
    const double mu = gap();
    const Way affine = direction(VectorXd::Zero(size_), VectorXd::Zero(muscles_));
    const double t = length(affine);
    const double after = ((z_ + t * affine.z).dot(lower_ + t * affine.lower) +
                          (r - t * affine.z.head(muscles_)).dot(upper_ + t * affine.upper)) /
                         static_cast<double>(size_ + muscles_);
    const double target = mu * std::pow(std::clamp(after / mu, 0.0, 1.0), 3);
    Way d = direction(VectorXd(target - affine.z.array() * affine.lower.array()),
                      VectorXd(target + affine.z.head(muscles_).array() * affine.upper.array()));
    double step = length(d);
    if (step < 0.1) {
      d = direction(VectorXd::Constant(size_, 0.5 * mu), VectorXd::Constant(muscles_, 0.5 * mu));
      step = length(d);
    }
    if (!d.z.allFinite() || !d.y.allFinite() || !d.x.allFinite()) return false;
    step = std::min(1.0, kToBoundary * step);
    z_ += step * d.z;
    x_ += step * d.x;
    y_ += step * d.y;
    lower_ += step * d.lower;
    upper_ += step * d.upper;
    return true;
  }

  const EffortProgram& p_;
  Index muscles_, rows_, size_;
  MatrixXd all_, motion_;
  VectorXd cost_, required_;
  Eigen::LLT<MatrixXd> hessian_;
  double scale_ = 1.0;
  VectorXd z_, x_, y_, lower_, upper_;  // lower_, upper_: multipliers of the bounds
};

}  // namespace

EffortSolution solve_effort(const EffortProgram& program) { return Method(program).run(); }

}  // namespace palmar::grasp
