// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// A few skin vertices that are posed again and again while a hand closes: the influences of the
/// joints are sorted out once. Gives the same positions as pose_skin_vertices().
class PosableSkin {
 public:
  PosableSkin() = default;
  /// Keeps a pointer to `hand`, which must live longer.
  PosableSkin(const hand::Hand& hand, std::vector<int> vertices);

  const std::vector<int>& vertices() const { return vertices_; }

  /// Positions in the hand frame, in the order of vertices(), mm. `posed` is resized.
  void pose(const hand::Posture& posture, std::vector<Vec3>& posed) const;

 private:
  struct JointShare {
    hand::JointId joint{};
    std::vector<int> full;       ///< slots that follow the joint wholly
    std::vector<int> part;       ///< slots that follow it in part ...
    std::vector<double> weight;  ///< ... by w1 w2
  };
  struct JointBulge {
    hand::JointId joint{};
    std::vector<int> slot;
    std::vector<Vec3> bulge;  ///< mm per rad of flexion
  };
  const hand::Hand* hand_ = nullptr;
  std::vector<int> vertices_;
  std::vector<Vec3> reference_;
  std::vector<JointShare> shares_;  ///< distal to proximal
  std::vector<JointBulge> bulges_;
  bool has_thumb_ball_ = false;
};

}  // namespace palmar::grasp
