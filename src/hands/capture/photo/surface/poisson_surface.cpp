// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/poisson_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hands/capture/photo/surface/grid_solver.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::capture {
namespace {

/// The eight cells round a point and their trilinear shares.
struct Shares {
  std::array<std::size_t, 8> cell;
  std::array<float, 8> share;
};

/// `at` in cells, 0 at the middle of the first; held to the box.
Shares shares_of(const imaging::VolumeGrid& grid, const Vec3& at) {
  std::array<int, 3> low{};
  std::array<float, 3> f{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = std::clamp(at[static_cast<int>(a)], 0.0, grid.size[a] - 1.001);
    low[a] = static_cast<int>(x);
    f[a] = static_cast<float>(x - low[a]);
  }
  Shares shares;
  for (std::size_t n = 0; n < 8; ++n) {
    const int di = static_cast<int>(n & 1), dj = static_cast<int>((n >> 1) & 1);
    const int dk = static_cast<int>(n >> 2);
    shares.cell[n] = grid.at(low[0] + di, low[1] + dj, low[2] + dk);
    shares.share[n] =
        (di == 1 ? f[0] : 1 - f[0]) * (dj == 1 ? f[1] : 1 - f[1]) * (dk == 1 ? f[2] : 1 - f[2]);
  }
  return shares;
}

imaging::VolumeGrid grid_over(const imaging::VolumeGrid& box, double spacing) {
  imaging::VolumeGrid grid;
  grid.spacing = Vec3::Constant(spacing);
  grid.origin = box.origin;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto k = static_cast<int>(a);
    grid.size[a] = static_cast<int>(std::ceil((box.size[a] - 1) * box.spacing[k] / spacing)) + 1;
  }
  return grid;
}

/// Points per mm^2: hats of width H over the points, read with the same hat; across a surface that
/// lies anyhow the mean of hat times hat is 2/3.
imaging::Volume density_of(const std::vector<SurfacePoint>& points, const imaging::VolumeGrid& box,
                           double width) {
  imaging::Volume density{grid_over(box, width), {}};
  density.value.assign(density.grid.count(), 0.0F);
  const auto weight = static_cast<float>(1.5 / (width * width));
  for (const SurfacePoint& point : points) {
    const Shares shares =
        shares_of(density.grid, density.grid.to_voxel(point.position.cast<double>()));
    for (std::size_t n = 0; n < 8; ++n) density.value[shares.cell[n]] += weight * shares.share[n];
  }
  return density;
}

/// A step of 1 smoothed by a hat of half width 1: -1/2 to 1/2.
float smooth_step(float s) {
  const float c = std::clamp(s, -1.0F, 1.0F);
  return c - 0.5F * c * std::abs(c);
}

}  // namespace

void PoissonOptions::check() const {
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds) {
      throw UsageError(fmt::format("surface {}: {:g}; {} is allowed", field, value, allowed));
    }
  };
  require(spacing >= 0.2 && spacing <= 10, "spacing", spacing, "0.2 to 10 mm");
  require(screening > 0 && screening <= 1000, "screening", screening, "0 to 1000");
  require(tolerance > 0 && tolerance < 1, "tolerance", tolerance, "0 to 1");
  require(max_iterations >= 1, "max_iterations", max_iterations, "1 or more");
}

PoissonField fit_poisson_field(const std::vector<SurfacePoint>& points,
                               const imaging::Volume& bound, const PoissonOptions& options,
                               const Progress& progress) {
  options.check();
  if (points.empty()) throw InputError("no point of the surface is known; nothing can be fitted");
  PoissonField result;
  constexpr double kDensityWidth = 2.0;  // mm
  result.density = density_of(points, bound.grid, kDensityWidth);
  const imaging::VolumeGrid grid = grid_over(bound.grid, options.spacing);
  GridProblem problem;
  problem.size = grid.size;
  problem.w.assign(grid.count(), 0.0F);
  problem.b.assign(grid.count(), 0.0F);

  const double h = options.spacing;
  const auto pull = static_cast<float>(options.screening);
  constexpr float kLargestArea = 4.0F;  // mm^2; a lonely point is no more than that
  const std::array<std::size_t, 3> next = {1, static_cast<std::size_t>(grid.size[0]),
                                           static_cast<std::size_t>(grid.size[0]) * grid.size[1]};
  for (const SurfacePoint& point : points) {
    const Vec3 position = point.position.cast<double>();
    const Vec3 at = grid.to_voxel(position);
    const float density = imaging::value_at(result.density, result.density.grid.to_voxel(position));
    const float area = std::min(kLargestArea, 1.0F / std::max(density, 1e-6F));
    const float scale = area / static_cast<float>(h * h);
    for (std::size_t a = 0; a < 3; ++a) {
      // Face f of an axis lies between cells f and f + 1.
      const auto k = static_cast<int>(a);
      Vec3 face = at;
      face[k] -= 0.5;
      if (face[k] < 0.0 || face[k] > grid.size[a] - 2.001) continue;
      const Shares shares = shares_of(grid, face);
      for (std::size_t n = 0; n < 8; ++n) {
        const float g = -point.normal[k] * scale * shares.share[n];
        problem.b[shares.cell[n]] -= g;
        if (shares.cell[n] + next[a] < problem.b.size()) problem.b[shares.cell[n] + next[a]] += g;
      }
    }
    const Shares shares = shares_of(grid, at);
    const Vec3 low = at.array().floor().matrix();
    for (std::size_t n = 0; n < 8; ++n) {
      const Vec3 cell = low + Vec3(static_cast<double>(n & 1), static_cast<double>((n >> 1) & 1),
                                   static_cast<double>(n >> 2));
      const auto outside = static_cast<float>(point.normal.cast<double>().dot(cell - at));
      const float weight = pull * scale * shares.share[n];
      problem.w[shares.cell[n]] += weight;
      problem.b[shares.cell[n]] += weight * smooth_step(-outside);
    }
  }
  parallel_for(grid.size[2], [&](int k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        constexpr float kOutside = 1e-3F, kFirm = 10.0F;
        if (imaging::value_at(bound, bound.grid.to_voxel(grid.to_patient(Vec3(i, j, k)))) >=
            kOutside) {
          continue;
        }
        const std::size_t c = grid.at(i, j, k);
        problem.w[c] += kFirm;
        problem.b[c] -= 0.5F * kFirm;
      }
    }
  });
  GridSolution solution = solve_grid(problem, options.tolerance, options.max_iterations, progress);
  result.field = {grid, std::move(solution.x)};
  result.iterations = solution.iterations;
  result.residual = solution.residual;
  result.has_converged = solution.has_converged;
  return result;
}

}  // namespace palmar::capture
