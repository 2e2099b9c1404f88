// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "palmar/core/parallel.h"

namespace palmar::product {
namespace {

// Directions in which hulls are measured: primitive vectors of whole numbers up to 3, at most 18
// degrees apart along a circle, so that a disc's hull reaches beyond it by 1.3 % of its radius.
std::vector<Vec3> hull_directions() {
  constexpr int kLargest = 3;
  std::vector<Vec3> result;
  for (int i = -kLargest; i <= kLargest; ++i) {
    for (int j = -kLargest; j <= kLargest; ++j) {
      for (int k = -kLargest; k <= kLargest; ++k) {
        if (std::gcd(std::gcd(i, j), k) != 1) continue;
        if (i < 0 || (i == 0 && (j < 0 || (j == 0 && k < 0)))) continue;
        result.push_back(Vec3(i, j, k).normalized());
      }
    }
  }
  return result;
}

}  // namespace

int nearest_part(const std::vector<SolidBall>& balls, const Vec3& point) {
  int part = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const SolidBall& ball : balls) {
    const double bound = least + ball.radius;
    const double squared = (point - ball.centre).squaredNorm();
    if (bound > 0.0 && squared < bound * bound) {
      least = std::sqrt(squared) - ball.radius;
      part = ball.part;
    }
  }
  return part;
}

PartRegion united(const PartRegion& a, const PartRegion& b) {
  PartRegion r = a;
  r.count += b.count;
  r.deepest = std::max(a.deepest, b.deepest);
  for (std::size_t d = 0; d < r.low.size(); ++d) {
    r.low[d] = std::min(a.low[d], b.low[d]);
    r.high[d] = std::max(a.high[d], b.high[d]);
  }
  return r;
}

PartRegions part_regions(const SolidGrid& grid, const std::vector<SolidBall>& balls, int parts) {
  PartRegions result;
  result.stride = grid.is_solid.size() > 60000 ? 2 : 1;
  result.directions = hull_directions();
  const int stride = result.stride;
  const std::vector<Vec3>& directions = result.directions;
  PartRegion nothing;
  nothing.low.assign(directions.size(), std::numeric_limits<double>::infinity());
  nothing.high.assign(directions.size(), -std::numeric_limits<double>::infinity());
  result.region.assign(parts, nothing);
  std::vector<std::vector<PartRegion>> of_slice((grid.size[2] + stride - 1) / stride);
  const std::size_t row = (grid.size[0] + stride - 1) / stride;
  const std::size_t layer = row * ((grid.size[1] + stride - 1) / stride);
  std::vector<int> owner(layer * of_slice.size(), -1);  // of every voxel that is looked at
  parallel_for(static_cast<int>(of_slice.size()), [&](int slice) {
    std::vector<PartRegion>& mine = of_slice[slice];
    mine.assign(parts, nothing);
    for (int j = 0; j < grid.size[1]; j += stride) {
      for (int i = 0; i < grid.size[0]; i += stride) {
        const std::size_t n = grid.index(i, j, slice * stride);
        if (grid.is_solid[n] == 0) continue;
        const Vec3 x = grid.centre(n);
        const int part = nearest_part(balls, x);
        owner[i / stride + row * (j / stride) + layer * slice] = part;
        PartRegion& r = mine[part];
        r.count += 1.0;
        r.deepest = std::max<double>(r.deepest, grid.depth[n]);
        for (std::size_t d = 0; d < directions.size(); ++d) {
          const double t = directions[d].dot(x);
          r.low[d] = std::min(r.low[d], t);
          r.high[d] = std::max(r.high[d], t);
        }
      }
    }
  });
  for (const std::vector<PartRegion>& slice : of_slice) {
    for (int p = 0; p < parts; ++p) {
      if (slice[p].count > 0.0) result.region[p] = united(result.region[p], slice[p]);
    }
  }
  const double face = std::pow(stride * grid.spacing, 2.0);
  // The grid's border is air: the voxel after the last of a row or layer is never solid.
  for (const std::size_t step : {std::size_t{1}, row, layer}) {
    for (std::size_t n = 0; n + step < owner.size(); ++n) {
      const int a = owner[n], b = owner[n + step];
      if (a >= 0 && b >= 0 && a != b) result.border[std::minmax(a, b)] += face;
    }
  }
  return result;
}

double hollowness(const SolidGrid& grid, const PartRegions& regions, const PartRegion& region,
                  double limit) {
  const std::vector<Vec3>& directions = regions.directions;
  const int stride = regions.stride;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (std::size_t d = 0; d < directions.size(); ++d) {
    for (int a = 0; a < 3; ++a) {
      if (directions[d][a] == 1.0) {
        low[a] = region.low[d];
        high[a] = region.high[d];
      }
    }
  }
  std::array<int, 3> begin{}, end{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double half = 0.5 * (grid.size[a] - 1);
    begin[a] = std::max(0, static_cast<int>(std::ceil(low[a] / grid.spacing + half - 1e-6)));
    begin[a] = (begin[a] + stride - 1) / stride * stride;
    end[a] = std::min(grid.size[a] - 1,
                      static_cast<int>(std::floor(high[a] / grid.spacing + half + 1e-6)));
  }
  double deepest = 0.0;
  for (int k = begin[2]; k <= end[2]; k += stride) {
    for (int j = begin[1]; j <= end[1]; j += stride) {
      for (int i = begin[0]; i <= end[0]; i += stride) {
        const std::size_t n = grid.index(i, j, k);
        if (grid.air[n] <= deepest) continue;
        const Vec3 x = grid.centre(n);
        bool is_in = true;
        for (std::size_t d = 0; d < directions.size() && is_in; ++d) {
          const double t = directions[d].dot(x);
          is_in = t >= region.low[d] - 1e-6 && t <= region.high[d] + 1e-6;
        }
        if (is_in) deepest = grid.air[n];
        if (deepest > limit) return deepest;
      }
    }
  }
  return deepest;
}

}  // namespace palmar::product
