// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palmar::geometry {

/// Corners of the smallest convex polygon round points of a plane, counter-clockwise (x to the
/// right, y up) from the leftmost one, the lowest of those; points on its edges are no corners.
/// Fewer than three points that aren't on one line: the ends of the line, or the point; of none,
/// none. Source: Andrew 1979, "Another efficient algorithm for convex hulls in two dimensions".
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace palmar::geometry
