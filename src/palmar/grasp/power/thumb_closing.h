// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "palmar/core/enum_index.h"
#include "palmar/grasp/power/skin_advance.h"

namespace palmar::grasp {

/// The angles of the thumb's four joint motions on a product: CMC flexion and abduction, MP and IP
/// flexion, rad.
using ThumbPose = std::array<double, 4>;

/// Opposes the thumb of one hand to the fingers that are closed already.
///
/// Where the thumb goes is a least-squares fit of its four angles, the best that is reached from a
/// dozen ways of the metacarpal to the product and three dozen bent thumbs: its pad and proximal
/// phalanx lie on the surface, beside the index and middle finger, where it presses against what
/// fingertips press across the palm and else on the far side from the palm, on no end face, clear
/// of the fingers, with joints as near their ease as that allows. The fit itself has no steps: a
/// product or a hand that differs a little gets a thumb that differs a little, unless two places
/// are equally good.
class ThumbCloser {
 public:
  /// `groups`: the skin; `sparse`: some of it for the fit. All must live longer.
  ThumbCloser(const hand::Hand& hand, const FingerCones& cones, const DigitGroups& groups,
              const DigitGroups& sparse, const AdvanceCare& care);

  /// How well the thumb holds, as an area of contact that it is worth, mm^2.
  double worth(const HeldProduct& product, const DepthLimits& limits, const hand::Posture& posture,
               const Vec3& grip_axis_in_hand) const;

  /// Where the thumb holds best, fingers as in `start`.
  ThumbPose find_pose(const HeldProduct& product, const DepthLimits& limits,
                      const hand::Posture& start, const Vec3& grip_axis_in_hand) const;

  /// The fit that is reached from a pose (of another hand or a coarser skin, say).
  ThumbPose settled(const ThumbPose& from, const HeldProduct& product, const DepthLimits& limits,
                    const hand::Posture& start, const Vec3& grip_axis_in_hand) const;

  /// The thumb of `start` in that pose, and what holds it there.
  hand::Posture closed(const HeldProduct& product, const DepthLimits& limits,
                       const hand::Posture& start, const ThumbPose& pose,
                       std::array<SegmentStop, hand::kSegmentCount>& stops) const;

 private:
  /// The fingers that the thumb is opposed to.
  struct Opposed {
    std::vector<Obstacle> cones;
    Vec3 middle;  ///< between the distal joints of the index and middle finger, hand frame, mm
    Vec3 axis;    ///< grip axis, unit, hand frame
    Vec3 facing;  ///< where the product's surface under the thumb ought to face, unit, hand frame
    Quat hand_from_product;
  };
  Opposed opposed(const HeldProduct& product, const hand::Posture& posture,
                  const Vec3& grip_axis_in_hand) const;
  std::vector<Obstacle> obstacles(const hand::Posture& posture) const;
  Eigen::VectorXd residuals(const HeldProduct& product, const DepthLimits& limits,
                            const hand::Posture& posture, const Opposed& fingers) const;
  hand::Posture with(const hand::Posture& posture, const ThumbPose& pose) const;
  /// The metacarpal as far as it can go towards a flexion and an abduction [rad], then MP and IP
  /// bent until skin reaches its limit.
  ThumbPose reached(const HeldProduct& product, const DepthLimits& limits,
                    const hand::Posture& start, double flexion, double abduction) const;

  const hand::Hand* hand_;
  const FingerCones* cones_;
  const std::array<SkinGroup, 3>* groups_;
  const DigitGroups* sparse_;
  AdvanceCare care_;
  std::vector<double> volar_share_;  // of the CMC joint's sparse skin, see VolarSkin
  std::vector<std::size_t> pad_;     // those of the distal phalanx that have a share
  Vec3 volar_ = Vec3::UnitZ();       // of the distal phalanx, reference posture
};

}  // namespace palmar::grasp
