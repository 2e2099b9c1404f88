// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace palmar::cad {

/// A closed, evenly knotted cubic B-spline: curvature is continuous everywhere, the start included.
struct ClosedSpline {
  Eigen::MatrixXd poles;   ///< a row per pole
  double deviation = 0.0;  ///< of the farthest point from where the curve passes it
};

/// The one with fewest poles, 8 to `most_poles`, that passes points (a row each, in order, the
/// first not repeated) within `tolerance`; that with `most_poles` if none does. Least squares over
/// parameters by the length along the points, which are moved to the nearest ones on the curve a
/// few times. Fewer points than poles are never asked for: at most half as many poles as points,
/// and 4 at least. Throws UsageError for fewer than 4 points.
ClosedSpline fit_closed_spline(const Eigen::MatrixXd& points, double tolerance,
                               int most_poles = 40);

}  // namespace palmar::cad
