// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/grasp/grip.h"
#include "palmar/grasp/precision/fingertip_ik.h"

namespace palmar {

/// Round a ball, fingers slide up to this far and touch with their sides.
inline constexpr double kBallSlide = 8.0;   // mm
inline constexpr double kBallSquare = 0.9;  // rad

/// The fingers that take part in a precision or lateral grip, thumb first, and what of them
/// touches.
std::vector<FingertipPoint> fingertips_of(const Hand& hand, Grip grip);

/// How a hand likes to hold by a grip: the posture that the others are measured against. From the
/// stored postures (named_postures.h), with straighter end joints for a pinch of pads and spread
/// fingers round a ball.
Posture natural_posture(const Skeleton& skeleton, Grip grip);

/// A hand opened for a thing of some width between thumb and the other fingertips.
struct GripOpening {
  double width = 0.0;  ///< mm
  Posture posture;
  Vec3 thumb = Vec3::Zero();   ///< thumb's fingertip point, hand frame, mm
  Vec3 others = Vec3::Zero();  ///< mean of the others'
  double strain = 0.0;         ///< of the posture against natural_posture()
};

/// Openings from nearly closed to the widest that the hand can do with its fingertips perpendicular
/// to the thing (within 0.5 mm and 40 degrees). In between take the nearest.
class GripOpenings {
 public:
  GripOpenings(const FingertipIk& ik, Grip grip);

  Grip grip() const { return grip_; }
  const std::vector<FingertipPoint>& fingertips() const { return fingertips_; }
  const std::vector<GripOpening>& all() const { return openings_; }
  double widest() const { return openings_.empty() ? 0.0 : openings_.back().width; }
  const GripOpening& at(double width) const;

 private:
  Grip grip_;
  std::vector<FingertipPoint> fingertips_;
  std::vector<GripOpening> openings_;
};

}  // namespace palmar
