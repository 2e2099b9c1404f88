// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/grid_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/parallel.h"

namespace palmar::capture {
namespace {

/// The box' operator, cell by cell, as its definition says.
std::vector<float> applied(const GridProblem& problem, const std::vector<float>& x) {
  const auto [ni, nj, nk] = problem.size;
  const auto at = [&, ni = ni, nj = nj](int i, int j, int k) {
    return static_cast<std::size_t>((k * nj + j) * ni + i);
  };
  std::vector<float> result(x.size());
  for (int k = 0; k < nk; ++k) {
    for (int j = 0; j < nj; ++j) {
      for (int i = 0; i < ni; ++i) {
        double sum = static_cast<double>(problem.w[at(i, j, k)]) * x[at(i, j, k)];
        const auto add = [&](int a, int b, int c) {
          if (a < 0 || b < 0 || c < 0 || a >= problem.size[0] || b >= problem.size[1] ||
              c >= problem.size[2]) {
            return;
          }
          sum += static_cast<double>(x[at(i, j, k)]) - static_cast<double>(x[at(a, b, c)]);
        };
        add(i - 1, j, k);
        add(i + 1, j, k);
        add(i, j - 1, k);
        add(i, j + 1, k);
        add(i, j, k - 1);
        add(i, j, k + 1);
        result[at(i, j, k)] = static_cast<float>(sum);
      }
    }
  }
  return result;
}

/// Screened at a few cells only; sides that don't halve evenly.
GridProblem make_problem(std::vector<float>& x) {
  GridProblem problem;
  problem.size = {37, 22, 29};
  const std::size_t count = 37 * 22 * 29;
  problem.w.assign(count, 0.0F);
  x.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    x[c] = static_cast<float>(std::sin(0.01 * static_cast<double>(c)) +
                              0.3 * std::cos(1.7 * static_cast<double>(c)));
    if (c % 97 == 0) problem.w[c] = 2.0F;
  }
  problem.b = applied(problem, x);
  return problem;
}

TEST(SolveGrid, FindsAKnownField) {
  std::vector<float> x;
  const GridSolution solution = solve_grid(make_problem(x), 1e-5, 100);
  ASSERT_TRUE(solution.has_converged);
  EXPECT_LT(solution.iterations, 25);  // that is what multigrid is for
  double largest = 0.0;
  for (std::size_t c = 0; c < x.size(); ++c) {
    largest = std::max(largest, std::abs(static_cast<double>(solution.x[c] - x[c])));
  }
  EXPECT_LT(largest, 1e-3);  // of about 1; single precision and the tolerance
}

TEST(SolveGrid, ThreadsChangeNothing) {
  std::vector<float> x;
  const GridProblem problem = make_problem(x);
  set_thread_count(1);
  const GridSolution one = solve_grid(problem, 1e-4, 100);
  set_thread_count(3);
  const GridSolution three = solve_grid(problem, 1e-4, 100);
  set_thread_count(0);
  EXPECT_EQ(one.x, three.x);
}

TEST(SolveGrid, SaysWhenItHasNotConverged) {
  std::vector<float> x;
  const GridSolution solution = solve_grid(make_problem(x), 1e-6, 1);
  EXPECT_FALSE(solution.has_converged);
  EXPECT_GT(solution.residual, 1e-6);
}

}  // namespace
}  // namespace palmar::capture
