// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/sheet/sheet_grid.h"
#include "hands/imaging/distance_transform.h"

namespace palmar::capture {

/// A mask that is soft at its border, between cells.
class SoftMask {
 public:
  /// Keeps a pointer to the grid.
  SoftMask(const SheetGrid& grid, const imaging::VoxelMask& mask);
  /// Share of skin at a point of the sheet, 0 to 1.
  double operator()(const Eigen::Vector2d& sheet) const;
  /// How far one can go from a point inside until the border, mm; at most `most`.
  double reach(const Eigen::Vector2d& from, const Eigen::Vector2d& direction, double most) const;

 private:
  const SheetGrid* grid_;
  std::vector<float> value_;
};

/// A finger's middle line.
struct FingerAxis {
  Eigen::Vector2d point = Eigen::Vector2d::Zero(),
                  direction = Eigen::Vector2d::UnitY();  ///< unit, towards the tip

  double along(const Eigen::Vector2d& p) const { return (p - point).dot(direction); }
  /// How far to the side, unsigned.
  double aside(const Eigen::Vector2d& p) const {
    return std::abs(direction.x() * (p - point).y() - direction.y() * (p - point).x());
  }
  Eigen::Vector2d at(double along) const { return point + along * direction; }
};

/// Through the middles of cross-sections between 15 and 75 % of the way from the tip to the base.
FingerAxis axis_of(const SoftMask& skin, const Eigen::Vector2d& tip, const Eigen::Vector2d& base);

}  // namespace palmar::capture
