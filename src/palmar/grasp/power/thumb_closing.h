// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/grasp/power/skin_advance.h"

namespace palmar {

/// CMC angles that a thumb is asked to go to before its MP and IP joints bend, rad.
struct ThumbPose {
  double cmc_flexion = 0.0;
  double cmc_abduction = 0.0;
};

/// Opposes the thumb of one hand to the fingers that are closed already.
class ThumbCloser {
 public:
  /// `groups`: skin moved by the MP, the IP and the CMC joint. All must live longer.
  ThumbCloser(const Hand& hand, const FingerCones& cones, const std::array<SkinGroup, 3>& groups,
              const AdvanceCare& care)
      : hand_(&hand), cones_(&cones), groups_(&groups), care_(care) {}

  /// How well the thumb holds, mm^2: its skin in the product on the far side from the palm, placed
  /// across the handle, not hooked over an edge.
  double score(const HeldProduct& product, const Posture& posture,
               const Vec3& grip_axis_in_hand) const;

  /// The way for the metacarpal, of a dozen, after which the thumb holds best.
  ThumbPose find_pose(const HeldProduct& product, const DepthLimits& limits, const Posture& start,
                      const Vec3& grip_axis_in_hand) const;
  /// A way near another one that is at least as good.
  ThumbPose improved(const ThumbPose& goal, const HeldProduct& product, const DepthLimits& limits,
                     const Posture& start, const Vec3& grip_axis_in_hand) const;

  /// The best of some ways by this hand's own skin.
  ThumbPose best_of(const std::vector<ThumbPose>& goals, const HeldProduct& product,
                    const DepthLimits& limits, const Posture& start,
                    const Vec3& grip_axis_in_hand) const;

  /// Brings the metacarpal as far as it can go, then bends MP and IP.
  Posture wrap(const HeldProduct& product, const DepthLimits& limits, const Posture& start,
               const ThumbPose& goal, std::array<SegmentStop, kSegmentCount>& stops) const;

 private:
  std::vector<Obstacle> obstacles(const Posture& posture) const;

  const Hand* hand_;
  const FingerCones* cones_;
  const std::array<SkinGroup, 3>* groups_;
  AdvanceCare care_;
};

}  // namespace palmar
