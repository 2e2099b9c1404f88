// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/power/finger_cones.h"

namespace palmar::grasp {

/// A phalanx of a finger and one of the thumb that lie against each other and press with one force
/// along the line between their bones. It does nothing to the product.
struct ThumbPress {
  hand::Finger finger{};
  double overlap = 0.0;                    ///< of their flesh beyond that at the start, mm
  double force = 0.0;                      ///< N
  double stiffness = 0.0;                  ///< of force against overlap, N/mm
  GripVector moment = GripVector::Zero();  ///< of 1 N of it about the angles, mm
};

/// Where the thumb meets fingers while a grasp comes to rest. Flesh that overlaps by D beyond what
/// it did at the start pushes the bones apart with
///
///     N = 2 N (D / 4 mm)^4.
///
/// A fingertip pressed 2 mm deep gives 1.5 to 2.5 N (thesis band, ball of 7 mm); two of them, 2 mm
/// each, make D = 4 mm. The power is our choice: bones don't pass each other.
class ThumbMeeting {
 public:
  /// Keeps a reference to the hand.
  ThumbMeeting(const hand::Hand& hand, const hand::Posture& start);

  /// Of all phalanges that overlap with the thumb's.
  std::vector<ThumbPress> presses(const hand::Posture& posture) const;

 private:
  const hand::Hand* hand_;
  FingerCones cones_;
  std::vector<RoundCone> start_;
};

/// Force and moments of two cones of one hand that overlap by so much more than at the start.
ThumbPress thumb_press(const hand::Skeleton& skeleton, const hand::Posture& posture,
                       const RoundCone& thumb, const RoundCone& finger, double overlap);

}  // namespace palmar::grasp
