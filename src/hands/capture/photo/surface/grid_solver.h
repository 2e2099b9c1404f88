// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/core/progress.h"

namespace palmar::capture {

/// (L + diag(w)) x = b on the cells of a box, L the graph Laplacian of the six neighbours (sum over
/// the neighbours that exist of x_i - x_j), w >= 0 and not all 0. Cells in the order i fastest.
struct GridProblem {
  std::array<int, 3> size = {0, 0, 0};
  std::vector<float> w;
  std::vector<float> b;
};

struct GridSolution {
  std::vector<float> x;
  int iterations = 0;
  double residual = 0.0;  ///< |b - A x| / |b|
  bool has_converged = false;
};

/// Conjugate gradients, preconditioned by a multigrid V-cycle: red-black Gauss-Seidel, cells halved
/// along each axis, values handed down as means and up as they are. Not converging is reported,
/// never thrown. The same for any number of threads. Source: Tatebe 1993, "The multigrid
/// preconditioned conjugate gradient method".
GridSolution solve_grid(const GridProblem& problem, double tolerance, int max_iterations,
                        const Progress& progress = {});

}  // namespace palmar::capture
