// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/finger_axis.h"

#include <algorithm>
#include <cmath>

#include "hands/capture/picture_vectors.h"
#include "hands/capture/sheet/line_fit.h"
#include "palmar/core/parallel.h"

namespace palmar::capture {

SoftMask::SoftMask(const SheetGrid& grid, const imaging::VoxelMask& mask)
    : grid_(&grid), value_(mask.size()) {
  parallel_for(grid.height, [&](int y) {
    for (int x = 0; x < grid.width; ++x) {
      float sum = 0.0F;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u) {
          sum += mask[grid.at(std::clamp(x + u, 0, grid.width - 1),
                              std::clamp(y + v, 0, grid.height - 1))];
        }
      }
      value_[grid.at(x, y)] = sum / 9.0F;
    }
  });
}

double SoftMask::operator()(const Vec2& sheet) const {
  const SheetGrid& grid = *grid_;
  const Vec2 p = grid.place(sheet);
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  if (x < 0 || y < 0 || x + 1 >= grid.width || y + 1 >= grid.height) return 0.0;
  const double u = p.x() - x, v = p.y() - y;
  return (1 - v) * ((1 - u) * value_[grid.at(x, y)] + u * value_[grid.at(x + 1, y)]) +
         v * ((1 - u) * value_[grid.at(x, y + 1)] + u * value_[grid.at(x + 1, y + 1)]);
}

double SoftMask::reach(const Vec2& from, const Vec2& direction, double most) const {
  constexpr double kStep = 0.1;  // mm
  double before = (*this)(from);
  for (double s = kStep; s < most; s += kStep) {
    const double here = (*this)(from + s * direction);
    if (here < 0.5) return before > here ? s - kStep * (0.5 - here) / (before - here) : s;
    before = here;
  }
  return most;
}

FingerAxis axis_of(const SoftMask& skin, const Vec2& tip, const Vec2& base) {
  FingerAxis axis{base, (tip - base).normalized()};
  for (int round = 0; round < 4; ++round) {
    const Vec2 across(-axis.direction.y(), axis.direction.x());
    const double length = (tip - base).dot(axis.direction);
    std::vector<Vec2> middles;
    for (int k = 0; k < 13; ++k) {
      const Vec2 c = axis.at(axis.along(tip) - (0.15 + 0.05 * k) * length);
      const double left = skin.reach(c, across, 18.0), right = skin.reach(c, -across, 18.0);
      middles.push_back(c + 0.5 * (left - right) * across);
    }
    const FittedLine line = fit_line(middles);
    const double sign = line.direction.dot(axis.direction) < 0.0 ? -1.0 : 1.0;
    axis = {line.point, sign * line.direction};
  }
  return axis;
}

}  // namespace palmar::capture
