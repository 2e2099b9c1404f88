// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Rotation followed by translation. Read names as a chain: product_from_hand maps a point given in
/// the hand frame to the product frame, and a_from_c = a_from_b * b_from_c.
struct Rigid3 {
  Quat rotation = Quat::Identity();  ///< unit quaternion
  Vec3 translation = Vec3::Zero();   ///< mm

  Vec3 operator*(const Vec3& point) const { return rotation * point + translation; }
  Rigid3 operator*(const Rigid3& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
  Rigid3 inverse() const {
    const Quat r = rotation.conjugate();
    return {r, -(r * translation)};
  }

  /// Rotation by `angle` [rad, right-handed] about the line through `centre` [mm] along the unit
  /// vector `axis`: Rot(u, p, theta) of Xie 2014, eq. (2-7).
  static Rigid3 about_axis(const Vec3& axis, const Vec3& centre, double angle) {
    const Quat r(Eigen::AngleAxisd(angle, axis));
    return {r, centre - r * centre};
  }
};

}  // namespace palmar::geometry
