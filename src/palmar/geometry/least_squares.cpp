// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

/// Variables that stand on a wall and are pushed against it by the gradient.
std::vector<char> held_by_walls(const LeastSquaresProblem& problem, const Eigen::VectorXd& x,
                                const Eigen::VectorXd& gradient) {
  std::vector<char> held(x.size(), 0);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    held[j] = (x[j] <= problem.lower[j] && gradient[j] >= 0.0) ||
              (x[j] >= problem.upper[j] && gradient[j] <= 0.0);
  }
  return held;
}

/// Largest cosine between the residual and a free column of the Jacobian.
double largest_cosine(const LeastSquaresSolution& at, const Eigen::VectorXd& gradient) {
  const double length = at.residual.norm();
  double largest = 0.0;
  for (Eigen::Index j = 0; j < gradient.size(); ++j) {
    const double column = at.jacobian.col(j).norm();
    if (at.at_bound[j] || column == 0.0 || length == 0.0) continue;
    largest = std::max(largest, std::abs(gradient[j]) / (column * length));
  }
  return largest;
}

/// Damped Gauss-Newton step of the free variables, cut at the walls.
Eigen::VectorXd damped_step(const LeastSquaresProblem& problem, const LeastSquaresSolution& at,
                            const Eigen::VectorXd& gradient, const Eigen::VectorXd& scale,
                            double damping) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index j = 0; j < gradient.size(); ++j) {
    if (!at.at_bound[j]) free.push_back(j);
  }
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd normal(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    right[i] = -gradient[free[i]];
    for (Eigen::Index j = 0; j < n; ++j) {
      normal(i, j) = at.jacobian.col(free[i]).dot(at.jacobian.col(free[j]));
    }
    normal(i, i) += damping * scale[free[i]];
  }
  const Eigen::VectorXd solved = normal.ldlt().solve(right);
  Eigen::VectorXd target = at.x;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::isfinite(solved[i])) target[free[i]] += solved[i];
  }
  return target.cwiseMax(problem.lower).cwiseMin(problem.upper) - at.x;
}

/// Every variable moves by less than counts, on its own scale.
bool is_small(const LeastSquaresProblem& problem, const Eigen::VectorXd& x,
              const Eigen::VectorXd& step, double tolerance) {
  constexpr double kRounding = 1e-16;
  const Eigen::ArrayXd range = (problem.upper - problem.lower).array();
  return (step.array().abs() <= tolerance * x.array().abs() + kRounding * range).all();
}

}  // namespace

void LeastSquaresOptions::check() const {
  if (max_iterations < 1) {
    throw UsageError("least squares: at most " + std::to_string(max_iterations) +
                     " iterations; 1 or more are required");
  }
  if (!(gradient_tolerance > 0.0 && step_tolerance > 0.0)) {
    throw UsageError("least squares: a tolerance is 0 or less; more than 0 is required");
  }
}

LeastSquaresSolution solve_least_squares(const LeastSquaresProblem& problem,
                                         const Eigen::VectorXd& start,
                                         const LeastSquaresOptions& options) {
  options.check();
  const Eigen::Index n = start.size();
  if (n == 0 || problem.lower.size() != n || problem.upper.size() != n ||
      !(problem.lower.array() < problem.upper.array()).all()) {
    throw UsageError("least squares: " + std::to_string(n) +
                     " variables; at least one is required, each with a lower bound below its "
                     "upper one");
  }
  LeastSquaresSolution at;
  at.x = start.cwiseMax(problem.lower).cwiseMin(problem.upper);
  at.at_bound.assign(n, 0);
  problem.evaluate(at.x, at.residual, &at.jacobian);
  at.sum_of_squares = at.residual.squaredNorm();
  if (!std::isfinite(at.sum_of_squares) || !at.jacobian.allFinite()) return at;

  at.status = LeastSquaresStatus::kIterationLimit;
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(n);
  double damping = 1e-3;
  double growth = 2.0;
  Eigen::VectorXd trial;
  for (; at.iterations < options.max_iterations; ++at.iterations) {
    const Eigen::VectorXd gradient = at.jacobian.transpose() * at.residual;
    at.at_bound = held_by_walls(problem, at.x, gradient);
    if (largest_cosine(at, gradient) <= options.gradient_tolerance) {
      at.status = LeastSquaresStatus::kConverged;
      return at;
    }
    const Eigen::VectorXd column = at.jacobian.colwise().squaredNorm().transpose();
    // A column that vanishes for a while must not make its variable leap.
    scale = scale.cwiseMax(column).cwiseMax(1e-12 * column.maxCoeff());
    const Eigen::VectorXd step = damped_step(problem, at, gradient, scale, damping);
    if (is_small(problem, at.x, step, options.step_tolerance)) {
      at.status = LeastSquaresStatus::kSmallStep;
      return at;
    }
    const double foretold = -2.0 * gradient.dot(step) - (at.jacobian * step).squaredNorm();
    problem.evaluate(at.x + step, trial, nullptr);
    const double sum = trial.squaredNorm();
    const double gain = std::isfinite(sum) ? at.sum_of_squares - sum : -1.0;
    if (gain > 0.0) {
      at.x += step;
      problem.evaluate(at.x, at.residual, &at.jacobian);
      at.sum_of_squares = at.residual.squaredNorm();
      const double ratio = foretold > 0.0 ? gain / foretold : 0.5;
      damping *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3));
      damping = std::max(damping, 1e-15);
      growth = 2.0;
    } else {
      damping *= growth;
      growth *= 2.0;
    }
  }
  at.at_bound = held_by_walls(problem, at.x, at.jacobian.transpose() * at.residual);
  return at;
}

}  // namespace palmar::geometry
