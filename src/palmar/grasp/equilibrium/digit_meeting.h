// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/power/finger_cones.h"

namespace palmar::grasp {

/// A place along a digit's phalanx that lies in the flesh of another digit's or of the palm; both
/// press on each other with one force. It does nothing to the product.
struct DigitPress {
  double overlap = 0.0;                    ///< of their flesh beyond that where they are apart, mm
  double force = 0.0;                      ///< N
  double stiffness = 0.0;                  ///< of force against overlap, N/mm
  GripVector moment = GripVector::Zero();  ///< of 1 N of it about the angles, mm
};

/// Where digits meet while a grasp comes to rest: the thumb any finger, fingers their neighbours,
/// and fingertips the palm and the ball of the thumb. At each of five places along a phalanx of the
/// first, flesh that overlaps with the other's by D beyond what it does where digits are apart
/// pushes the bones apart with
///
///     N = 1 N (D / 4 mm)^4.
///
/// A fingertip pressed 2 mm deep gives 1.5 to 2.5 N (thesis band, ball of 7 mm); two of them, 2 mm
/// each, make D = 4 mm, at some two of the places. The power is our choice: bones don't pass each
/// other. Places, and not the nearest points of two bones, which jump where these are parallel.
class DigitMeeting {
 public:
  /// `apart`: the posture whose overlaps count as none. Keeps a reference to the hand.
  DigitMeeting(const hand::Hand& hand, const hand::Posture& apart);

  /// Of all places that overlap.
  std::vector<DigitPress> presses(const hand::Posture& posture) const;

  /// How the moments of all presses [N mm] change with the angles, N mm/rad: the loss per angle
  /// (columns), with the presses' own way of turning.
  GripMatrix stiffness(const hand::Posture& posture) const;

 private:
  struct Place {
    std::size_t first = 0, second = 0;  ///< of the cones
    double along = 0.0;                 ///< the first cone
    double apart = 0.0;                 ///< overlap that counts as none, mm
  };

  const hand::Hand* hand_;
  FingerCones cones_;
  std::vector<Place> places_;
};

}  // namespace palmar::grasp
