// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// A finger bone with the flesh round it: a cone with round ends from a to b, radius linear
/// between. Hand frame, mm.
struct RoundCone {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius_a = 0.0, radius_b = 0.0;
  hand::Finger finger = hand::Finger::kThumb;
  int level = 0;  ///< 0 metacarpal, 1 proximal, 2 middle, 3 distal phalanx (thumb: 0, 1, 2)
};

/// Share along the line from a to b at which it is nearest to a point, in [0, 1].
inline double nearest_share(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  return length2 > 0.0 ? std::clamp(along.dot(point - a) / length2, 0.0, 1.0) : 0.0;
}

/// How far a point is from a cone's surface, and the way out of it.
struct ConeDistance {
  double distance = 0.0;      ///< mm, negative inside
  Vec3 away = Vec3::UnitZ();  ///< unit; the slope of the distance
};

/// Exact for the hull of the two round ends, so without a kink where the point passes an end.
ConeDistance distance_from(const RoundCone& cone, const Vec3& point);
inline double distance_to(const RoundCone& cone, const Vec3& point) {
  return distance_from(cone, point).distance;
}

/// How deep two cones overlap (along the shortest line between their centre lines), mm; negative
/// is a gap.
double overlap(const RoundCone& p, const RoundCone& q);

/// Where two cones are nearest to each other.
struct ConeContact {
  Vec3 point = Vec3::Zero();    ///< between their surfaces, mm
  Vec3 normal = Vec3::UnitZ();  ///< unit, from the first to the second
  double overlap = 0.0;         ///< mm
};
ConeContact contact_of(const RoundCone& p, const RoundCone& q);

/// Stand-ins for the fingers of one hand while it closes: cheap enough to keep fingers from
/// crossing each other at every step. Radii are the mean distance of the skin from the bone line.
class FingerCones {
 public:
  explicit FingerCones(const hand::Hand& hand);

  /// All cones in a posture, finger by finger from the metacarpal outwards.
  std::vector<RoundCone> posed(const hand::Skeleton& skeleton, const hand::Posture& posture) const;

 private:
  struct Part {
    RoundCone cone;
    std::optional<hand::Segment> segment;  ///< phalanx that carries it; a metacarpal otherwise
  };
  std::vector<Part> parts_;
};

}  // namespace palmar::grasp
