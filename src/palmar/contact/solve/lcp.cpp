// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/lcp.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "palmar/contact/solve/packed_cholesky.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

/// Values below this share of the largest one are rounding, not infeasibility.
constexpr double kRoundingShare = 1e-13;

/// p and s for a guess of which variables are in contact.
struct Complementary {
  Eigen::VectorXd force;  ///< m; zero outside the contact set
  Eigen::VectorXd gap;    ///< m; R p + d, so but for rounding zero inside the contact set
  bool is_finite = false;
};

/// d + R p. Four columns at a time: the sum is read and written less often.
Eigen::VectorXd gap_of(const ContactProblem& problem, const Eigen::VectorXd& force) {
  const Eigen::MatrixXd& R = problem.response;
  Eigen::VectorXd gap = problem.distance;
  int next[4];
  int count = 0;
  for (int j = 0; j < static_cast<int>(force.size()); ++j) {
    if (force[j] == 0.0) continue;
    next[count++] = j;
    if (count < 4) continue;
    gap += force[next[0]] * R.col(next[0]) + force[next[1]] * R.col(next[1]) +
           force[next[2]] * R.col(next[2]) + force[next[3]] * R.col(next[3]);
    count = 0;
  }
  for (int k = 0; k < count; ++k) gap += force[next[k]] * R.col(next[k]);
  return gap;
}

/// Solves R_FF p_F = -d_F and s = R_:F p_F + d, where F is the contact set.
Complementary solve_for_set(const ContactProblem& problem, const std::vector<int>& contact,
                            bool is_symmetric, PackedCholesky& factor) {
  const Eigen::Index m = problem.distance.size();
  Complementary result{Eigen::VectorXd::Zero(m), problem.distance, true};
  if (contact.empty()) return result;
  const Eigen::VectorXd d_F = problem.distance(contact);
  Eigen::VectorXd p_F;
  if (is_symmetric && factor.factor(problem.response, contact)) {
    p_F = -factor.solve(d_F);
  } else {
    // An indefinite block can't be factored by Cholesky but may still have an answer.
    const Eigen::MatrixXd R_FF = problem.response(contact, contact);
    p_F = -Eigen::PartialPivLU<Eigen::MatrixXd>(R_FF).solve(d_F);
  }
  for (std::size_t k = 0; k < contact.size(); ++k) {
    result.force[contact[k]] = p_F[static_cast<Eigen::Index>(k)];
  }
  result.gap = gap_of(problem, result.force);
  result.is_finite = p_F.allFinite() && result.gap.allFinite();
  return result;
}

double largest_magnitude(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
}

}  // namespace

void ContactProblem::check() const {
  check_sizes();
  // One pass that the compiler can vectorise; any infinity or NaN survives the sum.
  if (response.size() > 0 && !std::isfinite(response.sum())) {
    throw UsageError("contact problem: the response matrix has an entry that is not finite");
  }
}

void ContactProblem::check_sizes() const {
  if (response.rows() != response.cols()) {
    throw UsageError("contact problem: response matrix is " + std::to_string(response.rows()) +
                     " x " + std::to_string(response.cols()) + "; a square one is required");
  }
  if (response.rows() != distance.size()) {
    throw UsageError("contact problem: " + std::to_string(distance.size()) +
                     " distances for a response matrix of " + std::to_string(response.rows()) +
                     " rows; the numbers must be equal");
  }
  for (Eigen::Index i = 0; i < distance.size(); ++i) {
    if (!std::isfinite(distance[i])) {
      throw UsageError("contact problem: distance of vertex " + std::to_string(i) +
                       " is not finite; a length in mm is required");
    }
  }
}

void LcpOptions::check() const {
  if (max_fruitless_blocks < 0) {
    throw UsageError("max_fruitless_blocks is " + std::to_string(max_fruitless_blocks) +
                     "; 0 or more is required");
  }
  if (max_pivots && *max_pivots < 1) {
    throw UsageError("max_pivots is " + std::to_string(*max_pivots) + "; 1 or more is required");
  }
}

namespace {

/// Fills the errors of a solution from its force and gap.
void measure_residual(const ContactProblem& problem, ContactSolution& solution) {
  solution.complementarity_error = 0.0;
  solution.relative_residual = 0.0;
  if (problem.distance.size() == 0) return;
  const double p_scale = std::max(largest_magnitude(solution.force), 1e-300);
  const double d_scale = std::max(largest_magnitude(problem.distance), 1e-300);
  for (Eigen::Index i = 0; i < solution.gap.size(); ++i) {
    const double s = solution.gap[i];
    const double p = solution.force[i];
    solution.complementarity_error = std::max(solution.complementarity_error, std::abs(s * p));
    solution.relative_residual =
        std::max(solution.relative_residual, std::abs(std::min(s / d_scale, p / p_scale)));
  }
}

}  // namespace

void recompute_residual(const ContactProblem& problem, ContactSolution& solution) {
  solution.gap = gap_of(problem, solution.force);
  measure_residual(problem, solution);
}

ContactSolution solve_contact(const ContactProblem& problem, const LcpOptions& options) {
  problem.check_sizes();
  options.check();
  const Eigen::Index m = problem.distance.size();
  ContactSolution solution;
  solution.force = Eigen::VectorXd::Zero(m);
  const int max_pivots = options.max_pivots.value_or(100 + 10 * static_cast<int>(m));
  const double d_scale = largest_magnitude(problem.distance);

  // Under a smooth product the contact ends where the penetration is half the deepest (Hertz: at
  // r^2 = R depth); to start there instead of with all penetrating vertices halves the first block.
  std::vector<char> in_contact(m);
  const double start = m > 0 ? 0.5 * std::min(0.0, problem.distance.minCoeff()) : 0.0;
  for (Eigen::Index i = 0; i < m; ++i) in_contact[i] = problem.distance[i] < start;
  // The deepest first: what is exchanged stands near the end, so that most of the factor stays.
  std::vector<int> by_depth(m);
  std::iota(by_depth.begin(), by_depth.end(), 0);
  const auto outside = std::stable_partition(by_depth.begin(), by_depth.end(),
                                             [&](int i) { return problem.distance[i] < 0.0; });
  std::sort(by_depth.begin(), outside, [&](int i, int j) {
    const double a = problem.distance[i];
    const double b = problem.distance[j];
    return a < b || (a == b && i < j);
  });
  PackedCholesky factor;
  std::vector<int> contact;
  std::vector<int> infeasible;
  int fewest_infeasible = static_cast<int>(m) + 1;
  int fruitless_left = options.max_fruitless_blocks;
  while (true) {
    contact.clear();
    for (const int i : by_depth) {
      if (in_contact[i]) contact.push_back(i);
    }
    Complementary trial = solve_for_set(problem, contact, options.is_symmetric, factor);
    if (!trial.is_finite) break;
    const double p_rounding = kRoundingShare * largest_magnitude(trial.force);
    infeasible.clear();
    for (int i = 0; i < static_cast<int>(m); ++i) {
      const bool ok =
          in_contact[i] ? trial.force[i] >= -p_rounding : trial.gap[i] >= -kRoundingShare * d_scale;
      if (!ok) infeasible.push_back(i);
    }
    if (infeasible.empty()) {
      solution.status = LcpStatus::kSolved;
      const bool is_clipped = (trial.force.array() < 0.0).any();  // by rounding
      solution.force = is_clipped ? Eigen::VectorXd(trial.force.cwiseMax(0.0)) : trial.force;
      solution.gap = is_clipped ? gap_of(problem, solution.force) : std::move(trial.gap);
      measure_residual(problem, solution);
      return solution;
    }
    if (solution.pivots >= max_pivots) break;
    ++solution.pivots;
    const int count = static_cast<int>(infeasible.size());
    if (count < fewest_infeasible) {
      fewest_infeasible = count;
      fruitless_left = options.max_fruitless_blocks;
    } else if (fruitless_left > 0) {
      --fruitless_left;
    } else {
      infeasible = {infeasible.back()};
    }
    for (const int i : infeasible) in_contact[i] = !in_contact[i];
  }
  recompute_residual(problem, solution);
  return solution;
}

}  // namespace palmar::contact
