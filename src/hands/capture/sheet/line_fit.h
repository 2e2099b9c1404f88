// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palmar::capture {

/// The line that passes points of a plane in the least squares of their distances from it.
struct FittedLine {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();       ///< mean of the points
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit, either way
  double error = 0.0;                                    ///< RMS distance
};
FittedLine fit_line(const std::vector<Eigen::Vector2d>& points);

/// a_x b_y - a_y b_x.
inline double cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace palmar::capture
