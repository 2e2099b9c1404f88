// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// The rotation R that makes the sum of |y - R x|^2 over pairs of points least, both taken from
/// their means; `sum` is that of y x^T. Never a reflection. Where points lie on a line, one of the
/// best. Source: Kabsch 1976; by singular values as Arun, Huang, Blostein 1987.
Eigen::Matrix3d fit_rotation(const Eigen::Matrix3d& sum);

/// The shortest rotation that brings direction `from` to `to`, of any lengths above 0; half a turn
/// about any axis perpendicular to them if they are opposite.
Quat shortest_rotation(const Vec3& from, const Vec3& to);

}  // namespace palmar::geometry
