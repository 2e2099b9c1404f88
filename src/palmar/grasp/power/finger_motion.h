// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/hand/skeleton.h"

namespace palmar::grasp {

/// What one degree of freedom does to everything it moves, in one posture: a point x of a part that
/// it moves goes, per radian,
///
///     dx = turn x (x - centre) + slide,
///
/// and a direction n goes dn = turn x n. Hand frame; mm, rad.
struct DofMotion {
  hand::Dof dof{};
  Vec3 turn = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  Vec3 slide = Vec3::Zero();  ///< mm/rad; of the thumb's CMC joint only

  Vec3 of_point(const Vec3& x) const { return turn.cross(x - centre) + slide; }
  Vec3 of_direction(const Vec3& n) const { return turn.cross(n); }
};

/// Rigid parts of the hand in a posture and how each of its 20 finger and thumb degrees of freedom
/// moves them: the exact derivatives of pose_skeleton(). At s = 0 of the CMC joint, where the limit
/// posture changes (Xie 2014, eq. 2-5), that of the side on which the range of motion is wider.
class FingerMotion {
 public:
  FingerMotion(const hand::Skeleton& skeleton, const hand::Posture& posture);

  const hand::PosedSkeleton& posed() const { return posed_; }
  /// Those that move a phalanx, from the palm outwards.
  const std::vector<DofMotion>& moving(hand::Segment phalanx) const {
    return moving_[index_of(phalanx)];
  }
  /// Those that move the thumb's metacarpal.
  const std::vector<DofMotion>& moving_thumb_metacarpal() const { return cmc_; }

 private:
  hand::PosedSkeleton posed_;
  std::array<std::vector<DofMotion>, hand::kSegmentCount> moving_;
  std::vector<DofMotion> cmc_;
};

}  // namespace palmar::grasp
