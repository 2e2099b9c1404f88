// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/grasp/power/skin_advance.h"

namespace palmar::grasp {

/// The volar side of a digit's phalanges, which lies on what is held.
struct VolarSkin {
  /// Per vertex of a group how much it speaks for the volar side of its phalanx: its area times the
  /// fourth power of the cosine between its direction from the bone and the phalanx' volar one.
  /// Adds up to one per phalanx; 0 off the phalanges and on the back.
  std::vector<double> share;
  /// Per phalanx from the palm the mean direction of its palmar skin from the bone, unit, hand
  /// frame, reference posture.
  std::vector<Vec3> direction;
};
VolarSkin volar_skin(const hand::Hand& hand, const SkinGroup& group, hand::Finger finger);

/// A distance as a residual: x up to `far`, beyond that growing like the square root, so that skin
/// far off pulls no harder than skin at `far`.
double softened(double x, double far);

}  // namespace palmar::grasp
