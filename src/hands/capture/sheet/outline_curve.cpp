// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/outline_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

constexpr double kWidestGap = 6.0;  // mm, of the forearm on the edge: folds, hair
constexpr double kLeastForearm = 25.0, kMostForearm = 110.0;  // mm
constexpr double kProminence = 12.0;                          // mm: of a fingertip over its webs

[[noreturn]] void fail_outline(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

/// Smoothed by a bell of `sigma` mm along the curve; ends stay.
std::vector<Vec2> smoothed(const std::vector<Vec2>& curve, double sigma, double step) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma / step));
  const int n = static_cast<int>(curve.size());
  std::vector<Vec2> result(curve.size());
  for (int i = 0; i < n; ++i) {
    Vec2 sum = Vec2::Zero();
    double whole = 0.0;
    for (int j = -reach; j <= reach; ++j) {
      const double w = std::exp(-0.5 * std::pow(j * step / sigma, 2));
      sum += w * curve[std::clamp(i + j, 0, n - 1)];
      whole += w;
    }
    result[i] = sum / whole;
  }
  return result;
}

}  // namespace

std::vector<Vec2> outline_of(const SheetGrid& grid, const imaging::VoxelMask& mask) {
  const auto is_in = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < grid.width && y < grid.height && mask[grid.at(x, y)] != 0;
  };
  int sx = 0, sy = 0;
  for (std::size_t p = 0; p < mask.size(); ++p) {
    if (mask[p] != 0) {
      sx = static_cast<int>(p % static_cast<std::size_t>(grid.width));
      sy = static_cast<int>(p / static_cast<std::size_t>(grid.width));
      break;
    }
  }
  // Along the cracks between cells; directions: right, down, left, up (rows go down). Beginning on
  // the upper edge of the first cell, leftwards: the mask lies to the left.
  static constexpr std::array<std::array<int, 2>, 4> kStep = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  int x = sx + 1, y = sy, direction = 2;
  std::vector<Vec2> corners;
  const int x0 = x, y0 = y;
  do {
    corners.push_back(grid.sheet(x - 0.5, y - 0.5));
    x += kStep[direction][0];
    y += kStep[direction][1];
    // Cells before the corner, to the left and to the right of the way.
    const auto cell = [&](bool left) {
      switch (direction) {
        case 0:
          return is_in(x, left ? y - 1 : y);
        case 1:
          return is_in(left ? x : x - 1, y);
        case 2:
          return is_in(x - 1, left ? y : y - 1);
        default:
          return is_in(left ? x - 1 : x, y - 1);
      }
    };
    if (!cell(true)) {
      direction = (direction + 3) % 4;  // left, round the mask's corner
    } else if (cell(false)) {
      direction = (direction + 1) % 4;  // right
    }
  } while (x != x0 || y != y0 || direction != 2);
  return corners;
}

OpenOutline open_outline(const SheetGrid& grid, const std::vector<Vec2>& closed,
                         const std::string& name) {
  const auto on_edge = [&](const Vec2& p) { return grid.to_edge(p) < 0.6 * grid.cell; };
  const std::size_t n = closed.size();
  // Stretches on the edge, those with small gaps between them taken together.
  struct Run {
    std::size_t first, count;
  };
  std::vector<Run> runs;
  std::size_t start = 0;
  while (start < n && on_edge(closed[start])) ++start;
  const auto gap = static_cast<std::size_t>(kWidestGap / grid.cell);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = (start + i) % n;
    if (!on_edge(closed[p])) continue;
    if (!runs.empty() && i - (runs.back().first + runs.back().count) <= gap) {
      runs.back().count = i + 1 - runs.back().first;
    } else {
      runs.push_back({i, 1});
    }
  }
  if (runs.empty()) {
    fail_outline(
        name,
        "the hand ends within the sheet: the forearm must cross an edge of the sheet, bare, "
        "with the crease of the wrist at the edge (a sleeve or a bracelet hides it)");
  }
  const Run forearm = *std::max_element(
      runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.count < b.count; });
  OpenOutline result;
  result.from = closed[(start + forearm.first + forearm.count - 1) % n];
  result.to = closed[(start + forearm.first) % n];
  const Vec2 across = result.to - result.from;
  if (std::min(std::abs(across.x()), std::abs(across.y())) > 6.0) {
    fail_outline(name, "the forearm crosses a corner of the sheet; it must cross one edge");
  }
  if (across.norm() < kLeastForearm || across.norm() > kMostForearm) {
    fail_outline(name, fmt::format("what crosses the sheet's edge is {:.0f} mm wide; the wrist, "
                                   "{:.0f} to {:.0f} mm, must be there",
                                   across.norm(), kLeastForearm, kMostForearm));
  }
  for (const Run& run : runs) {
    if (run.first == forearm.first || run.count * grid.cell < 2.0) continue;
    const Vec2 at = closed[(start + run.first + run.count / 2) % n];
    fail_outline(name,
                 fmt::format("the hand reaches beyond the sheet at ({:.0f}, {:.0f}) mm from its "
                             "middle, {:.0f} x {:.0f} mm: all but the wrist must be on it",
                             at.x(), at.y(), grid.cell * grid.width, grid.cell * grid.height));
  }
  for (std::size_t i = forearm.first + forearm.count; i < forearm.first + n; ++i) {
    result.curve.push_back(closed[(start + i) % n]);
  }
  result.curve = smoothed(result.curve, 0.7, grid.cell);
  return result;
}

OutlineExtremes extremes_of(const std::vector<Vec2>& curve, const Vec2& middle) {
  OutlineExtremes result;
  Extreme high{0, 0.0}, low{0, std::numeric_limits<double>::infinity()};
  bool rising = true;
  // The curve begins at the wrist: as if from a height of its own.
  low.height = (curve.front() - middle).norm();
  high = {0, low.height};
  rising = false;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double d = (curve[i] - middle).norm();
    if (rising) {
      if (d > high.height) high = {i, d};
      if (d < high.height - kProminence) {
        result.tips.push_back(high);
        low = {i, d};
        rising = false;
      }
    } else {
      if (d < low.height) low = {i, d};
      if (d > low.height + kProminence) {
        if (!result.tips.empty()) result.webs.push_back(low);
        high = {i, d};
        rising = true;
      }
    }
  }
  // What rises at the end is the forearm.
  if (!result.webs.empty() && result.webs.size() >= result.tips.size()) result.webs.pop_back();
  return result;
}

}  // namespace palmar::capture
