// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/convex_hull.h"

#include <algorithm>

namespace palmar::geometry {
namespace {

using Corner = Eigen::Vector2d;

/// Twice the area of a triangle, positive counter-clockwise.
double corner_turn(const Corner& a, const Corner& b, const Corner& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Corner& a, const Corner& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 2) return points;
  std::vector<Corner> hull;  // the lower chain forwards, the upper one backwards
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Corner& p : points) {
      while (hull.size() >= begin + 2 &&
             corner_turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();  // it begins the other chain
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace palmar::geometry
