// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// What is known of a hinge before any dot is looked at.
struct HingePrior {
  Vec3 axis = Vec3::UnitX(), point = Vec3::Zero();
  double axis_sd = 0.105;  ///< rad, in either direction: 6 degrees; people's differ by 5 to 8
  double point_sd = 1.5;   ///< mm, across the axis
  double dot_sd = 1.0;     ///< mm: skin slides over bones; see noise_of_dots()
  double turn = 0.0;       ///< rad; where to start
};

/// The dots of one part of a hand in two scans, mm.
struct DotGroup {
  std::vector<Vec3> before, after;
};
/// Standard deviation of a dot's place in one direction, mm, by how far the dots of every part are
/// from moving with it as a rigid body: three and more dots a part, of all parts together. Counted
/// with six samples of 1 mm, and between 0.5 and 1.5 mm: what slides together isn't seen.
double noise_of_dots(std::span<const DotGroup> groups);

/// The hinge that dots on the part behind it and what is known of it agree on best.
struct DotHinge {
  Vec3 axis = Vec3::UnitX(), point = Vec3::Zero();
  double turn = 0.0;        ///< rad
  double residual = 0.0;    ///< rms of the dots' distances, mm
  double axis_error = 0.0;  ///< standard error of the axis' tilt in either direction, rad
  double dots_error = 0.0;  ///< that of the axis by the dots alone, rad
  double dots_tilt = 0.0;   ///< of the axis by the dots alone against the prior's, rad
  /// The dots alone and the prior are farther apart than both are known (beyond 95 %).
  bool is_conflict = false;
};

/// Minimises over axis u (unit), point p and turn t
///   sum_i |Rot(u, p, t) x_i - y_i|^2 / s^2 + |u - u0|^2 / a^2 + |p - p0|^2 / b^2,
/// a and b the standard deviations of `prior`; s is its dot_sd as far as the dots' own residuals
/// don't show otherwise (it counts as two of them; not below half of it, as neighbouring dots
/// slide together). So dots weigh by what they know, which follows from their spread, number and
/// turn: the covariance C of the axis by the dots alone is s^2 (J^T J)^-1. If its tilt d from u0 is
/// beyond d^T (C + a^2)^-1 d = 5.99 (95 % of two dimensions), one of the two is wrong: the dots are
/// taken alone if they know the axis better than a, else both as before; `is_conflict` says so.
/// `before` and `after`: the dots x and y as the part before the hinge sees them, mm. Throws
/// UsageError unless there are as many of both, one at least.
DotHinge fit_dot_hinge(std::span<const Vec3> before, std::span<const Vec3> after,
                       const HingePrior& prior);

}  // namespace palmar::capture
