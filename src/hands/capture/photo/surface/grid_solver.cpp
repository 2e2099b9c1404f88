// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/grid_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/core/parallel.h"

namespace palmar::capture {
namespace {

using Field = std::vector<float>;

struct Level {
  std::array<int, 3> size{};
  Field w, b, x;

  std::ptrdiff_t row(int j, int k) const {
    return (static_cast<std::ptrdiff_t>(k) * size[1] + j) * size[0];
  }
  std::size_t count() const { return w.size(); }
};

/// Calls body(i, cell, sum of the neighbours' values, number of neighbours) for the cells of a row.
template <typename Body>
void for_row(const Level& level, const float* x, int j, int k, int first, int step, Body&& body) {
  const int ni = level.size[0];
  const std::ptrdiff_t along_j = ni;
  const std::ptrdiff_t along_k = static_cast<std::ptrdiff_t>(ni) * level.size[1];
  const std::ptrdiff_t begin = level.row(j, k);
  const bool low_j = j > 0, high_j = j + 1 < level.size[1];
  const bool low_k = k > 0, high_k = k + 1 < level.size[2];
  const int across = low_j + high_j + low_k + high_k;
  for (int i = first; i < ni; i += step) {
    const std::ptrdiff_t c = begin + i;
    float sum = 0.0F;
    int count = across;
    if (low_j) sum += x[c - along_j];
    if (high_j) sum += x[c + along_j];
    if (low_k) sum += x[c - along_k];
    if (high_k) sum += x[c + along_k];
    if (i > 0) {
      sum += x[c - 1];
      ++count;
    }
    if (i + 1 < ni) {
      sum += x[c + 1];
      ++count;
    }
    body(c, sum, static_cast<float>(count));
  }
}

void smooth(Level& level, int colour) {
  parallel_for(level.size[2], [&](int k) {
    for (int j = 0; j < level.size[1]; ++j) {
      for_row(level, level.x.data(), j, k, (j + k + colour) & 1, 2,
              [&](std::size_t c, float sum, float count) {
                level.x[c] = (level.b[c] + sum) / (count + level.w[c]);
              });
    }
  });
}

/// result = A x.
void apply(const Level& level, const Field& x, Field& result) {
  parallel_for(level.size[2], [&](int k) {
    for (int j = 0; j < level.size[1]; ++j) {
      for_row(level, x.data(), j, k, 0, 1, [&](std::size_t c, float sum, float count) {
        result[c] = (count + level.w[c]) * x[c] - sum;
      });
    }
  });
}

/// Of the eight cells below a coarse cell, those that exist.
template <typename Body>
void for_children(const Level& fine, int i, int j, int k, Body&& body) {
  for (int c = 2 * k; c < std::min(2 * k + 2, fine.size[2]); ++c) {
    for (int b = 2 * j; b < std::min(2 * j + 2, fine.size[1]); ++b) {
      for (int a = 2 * i; a < std::min(2 * i + 2, fine.size[0]); ++a) {
        body(fine.row(b, c) + a);
      }
    }
  }
}

template <typename Body>
void for_coarse(const Level& coarse, Body&& body) {
  parallel_for(coarse.size[2], [&](int k) {
    for (int j = 0; j < coarse.size[1]; ++j) {
      for (int i = 0; i < coarse.size[0]; ++i) {
        body(i, j, k, coarse.row(j, k) + i);
      }
    }
  });
}

/// A coarse face stands for four fine ones whose values differ over half the way: the coarse
/// operator is half of the sum over the fine cells, so b and w are halved sums.
constexpr float kHandedDown = 0.5F;

class Multigrid {
 public:
  explicit Multigrid(const GridProblem& problem) {
    Level level;
    level.size = problem.size;
    level.w = problem.w;
    level.x.resize(level.w.size());
    level.b.resize(level.w.size());
    levels_.push_back(std::move(level));
    constexpr int kSmallest = 5;
    while (*std::max_element(levels_.back().size.begin(), levels_.back().size.end()) > kSmallest) {
      const Level& fine = levels_.back();
      Level coarse;
      std::size_t count = 1;
      for (std::size_t a = 0; a < 3; ++a) {
        coarse.size[a] = (fine.size[a] + 1) / 2;
        count *= static_cast<std::size_t>(coarse.size[a]);
      }
      coarse.w.resize(count);
      coarse.x.resize(count);
      coarse.b.resize(count);
      for_coarse(coarse, [&](int i, int j, int k, std::size_t c) {
        float sum = 0.0F;
        for_children(fine, i, j, k, [&](std::size_t f) { sum += fine.w[f]; });
        coarse.w[c] = kHandedDown * sum;
      });
      levels_.push_back(std::move(coarse));
    }
    for (const Level& one : levels_) rest_.emplace_back(one.count());
  }

  const Level& finest() const { return levels_.front(); }

  /// About A^-1 r; a symmetric operator.
  const Field& precondition(const Field& r) {
    levels_.front().b = r;
    cycle(0);
    return levels_.front().x;
  }

 private:
  void cycle(std::size_t l) {
    Level& level = levels_[l];
    std::fill(level.x.begin(), level.x.end(), 0.0F);
    const bool is_last = l + 1 == levels_.size();
    constexpr int kSweeps = 2, kSweepsOfLast = 20;
    for (int s = 0; s < (is_last ? kSweepsOfLast : kSweeps); ++s) {
      smooth(level, 0);
      smooth(level, 1);
    }
    if (!is_last) {
      Field& rest = rest_[l];
      apply(level, level.x, rest);
      parallel_for(level.size[2], [&](int k) {
        const auto begin = static_cast<std::size_t>(level.row(0, k));
        const auto end = static_cast<std::size_t>(level.row(0, k + 1));
        for (std::size_t c = begin; c < end; ++c) rest[c] = level.b[c] - rest[c];
      });
      Level& coarse = levels_[l + 1];
      for_coarse(coarse, [&](int i, int j, int k, std::size_t c) {
        float sum = 0.0F;
        for_children(level, i, j, k, [&](std::size_t f) { sum += rest[f]; });
        coarse.b[c] = kHandedDown * sum;
      });
      cycle(l + 1);
      for_coarse(coarse, [&](int i, int j, int k, std::size_t c) {
        for_children(level, i, j, k, [&](std::size_t f) { level.x[f] += coarse.x[c]; });
      });
    }
    for (int s = 0; s < (is_last ? kSweepsOfLast : kSweeps); ++s) {
      smooth(level, 1);
      smooth(level, 0);
    }
  }

  std::vector<Level> levels_;
  std::vector<Field> rest_;
};

/// Layer by layer, so that threads don't change it.
double dot(const Level& level, const Field& a, const Field& b) {
  std::vector<double> sums(level.size[2]);
  parallel_for(level.size[2], [&](int k) {
    double sum = 0.0;
    const auto end = static_cast<std::size_t>(level.row(0, k + 1));
    for (auto c = static_cast<std::size_t>(level.row(0, k)); c < end; ++c) {
      sum += static_cast<double>(a[c]) * static_cast<double>(b[c]);
    }
    sums[k] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// a += factor b
void add(const Level& level, Field& a, float factor, const Field& b) {
  parallel_for(level.size[2], [&](int k) {
    const auto end = static_cast<std::size_t>(level.row(0, k + 1));
    for (auto c = static_cast<std::size_t>(level.row(0, k)); c < end; ++c) a[c] += factor * b[c];
  });
}

}  // namespace

GridSolution solve_grid(const GridProblem& problem, double tolerance, int max_iterations,
                        const Progress& progress) {
  Multigrid multigrid(problem);
  const Level& level = multigrid.finest();
  GridSolution solution;
  solution.x.assign(level.count(), 0.0F);
  Field r = problem.b;
  const double whole = std::sqrt(dot(level, r, r));
  if (whole == 0.0) {
    solution.has_converged = true;
    return solution;
  }
  Field p = multigrid.precondition(r);
  Field product(level.count());
  double rz = dot(level, r, p);
  while (true) {
    solution.residual = std::sqrt(dot(level, r, r)) / whole;
    solution.has_converged = solution.residual <= tolerance;
    if (solution.has_converged || solution.iterations == max_iterations) return solution;
    progress.update(std::clamp(std::log(solution.residual) / std::log(tolerance), 0.0, 1.0),
                    "fitting the surface");
    apply(level, p, product);
    const double curvature = dot(level, p, product);
    if (!(curvature > 0.0)) return solution;
    const double step = rz / curvature;
    add(level, solution.x, static_cast<float>(step), p);
    add(level, r, static_cast<float>(-step), product);
    const Field& z = multigrid.precondition(r);
    const double next = dot(level, r, z);
    const auto share = static_cast<float>(next / rz);
    rz = next;
    parallel_for(level.size[2], [&](int k) {
      const auto end = static_cast<std::size_t>(level.row(0, k + 1));
      for (auto c = static_cast<std::size_t>(level.row(0, k)); c < end; ++c) {
        p[c] = z[c] + share * p[c];
      }
    });
    ++solution.iterations;
  }
}

}  // namespace palmar::capture
