// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_wall.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace palmar::redesign {
namespace {

using Point2 = Eigen::Vector2d;

constexpr int kOutlinePoints = 144;

double distance_to_segment(const Point2& p, const Point2& a, const Point2& b) {
  const Point2 step = b - a;
  const double length2 = step.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((p - a).dot(step) / length2, 0.0, 1.0) : 0.0;
  return (p - a - share * step).norm();
}

/// `outline`: point of the side in the plane of z, from the centre line; `t` goes round once from 0
/// to 1.
std::optional<double> thinnest_over(const HandleBody& body,
                                    const std::function<Point2(double z, double t)>& outline) {
  const HandleOutlines& hollow = body.hollow;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < hollow.z.size(); ++row) {
    const std::vector<double>& radius = hollow.radius[row];
    const auto columns = radius.size();
    const auto at = [&](std::size_t k) {
      const double phi = kFullTurn * static_cast<double>(k) / static_cast<double>(columns);
      return Point2(radius[k] * std::cos(phi), radius[k] * std::sin(phi));
    };
    if (*std::max_element(radius.begin(), radius.end()) <= 0.0) continue;
    for (int i = 0; i < kOutlinePoints; ++i) {
      const Point2 p = outline(hollow.z[row], static_cast<double>(i) / kOutlinePoints);
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < columns; ++k) {
        const std::size_t next = (k + 1) % columns;
        if (radius[k] <= 0.0) continue;
        nearest = std::min(nearest, radius[next] > 0.0 ? distance_to_segment(p, at(k), at(next))
                                                       : (p - at(k)).norm());
      }
      double column = std::atan2(p.y(), p.x()) / kFullTurn * static_cast<double>(columns);
      if (column < 0.0) column += static_cast<double>(columns);
      const auto k = static_cast<std::size_t>(column) % columns;
      const double share = column - std::floor(column);
      const double inner = radius[k] > 0.0 && radius[(k + 1) % columns] > 0.0
                               ? (1.0 - share) * radius[k] + share * radius[(k + 1) % columns]
                               : 0.0;
      least = std::min(least, p.norm() < inner ? -nearest : nearest);
    }
  }
  if (!std::isfinite(least)) return std::nullopt;
  return least;
}

}  // namespace

std::optional<double> thinnest_wall(const HandleShape& shape) {
  return thinnest_over(shape.body, [&](double z, double t) -> Point2 {
    return shape.side_point(z, t) - shape.body.centre_at(z);
  });
}

std::optional<double> thinnest_wall(const HandleBody& body) {
  return thinnest_over(body, [&](double z, double t) -> Point2 {
    const double phi = kFullTurn * t;
    return body.outlines.at(z, phi) * Point2(std::cos(phi), std::sin(phi));
  });
}

}  // namespace palmar::redesign
