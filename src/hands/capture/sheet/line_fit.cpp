// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/line_fit.h"

#include <cmath>

namespace palmar::capture {

FittedLine fit_line(const std::vector<Eigen::Vector2d>& points) {
  FittedLine line;
  if (points.empty()) return line;
  const auto count = static_cast<double>(points.size());
  for (const Eigen::Vector2d& p : points) line.point += p / count;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d q = p - line.point;
    xx += q.x() * q.x();
    xy += q.x() * q.y();
    yy += q.y() * q.y();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  line.direction = {std::cos(angle), std::sin(angle)};
  double sum = 0.0;
  for (const Eigen::Vector2d& p : points)
    sum += std::pow(cross2(line.direction, p - line.point), 2);
  line.error = std::sqrt(sum / count);
  return line;
}

}  // namespace palmar::capture
