// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar {

/// What is known of a hinge before any dot is looked at.
struct HingePrior {
  Vec3 axis = Vec3::UnitX(), point = Vec3::Zero();
  double axis_sd = 0.07;  ///< rad: 4 degrees
  double point_sd = 1.5;  ///< mm, across the axis
  double dot_sd = 1.0;    ///< mm: skin slides over bones
  double turn = 0.0;      ///< rad; where to start
};

/// The hinge that dots on the part behind it and what is known of it agree on best.
struct DotHinge {
  Vec3 axis = Vec3::UnitX(), point = Vec3::Zero();
  double turn = 0.0;      ///< rad
  double residual = 0.0;  ///< rms of the dots' distances, mm
};

/// Minimises over axis u (unit), point p and turn t
///   sum_i |Rot(u, p, t) x_i - y_i|^2 / s^2 + |u - u0|^2 / a^2 + |p - p0|^2 / b^2,
/// s, a and b the standard deviations of `prior`. `before` and `after`: the dots x and y as the
/// part before the hinge sees them, mm. Throws UsageError unless there are as many of both, one at
/// least.
DotHinge fit_dot_hinge(std::span<const Vec3> before, std::span<const Vec3> after,
                       const HingePrior& prior);

}  // namespace palmar
