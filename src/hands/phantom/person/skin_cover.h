// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/distance/mesh_distance.h"

namespace palmar::phantom {

inline constexpr double kLeastSkinCover = 2.0;  ///< over bone at the reference posture, mm

/// `point` moved along `direction` (unit length) until it lies `depth` under the skin or as deep as
/// it gets there, at most by `most`. mm.
inline Vec3 sunk(const geometry::MeshDistance& skin, const Vec3& point, const Vec3& direction,
                 double depth, double most) {
  constexpr double kStep = 0.05;
  Vec3 at = point;
  double cover = -skin.at(at).distance;
  for (double t = kStep; t <= most && cover < depth; t += kStep) {
    const Vec3 next = point + t * direction;
    const double there = -skin.at(next).distance;
    if (there <= cover) break;
    at = next;
    cover = there;
  }
  return at;
}

}  // namespace palmar::phantom
