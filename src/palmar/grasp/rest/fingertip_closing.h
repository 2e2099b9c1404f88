// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/grasp.h"
#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// How the joints of a precision grip press: each fingertip goes straight into the product. For a
/// finger whose fingertip is at x and meets the product's normal n, the rates q of its joints
/// minimise
///
///     |J q + n|^2 + (2 mm)^2 |q|^2 + (10 mm)^2 (q_DIP - 2/3 q_PIP)^2,
///
/// J the derivative of x, mm/rad. The skin doesn't slide then, however far the hand has to close to
/// reach a force. Flexing all joints alike instead shears a key out of the fingers. Joints at the
/// end of their range are left out. The two small weights are our choice.
class FingertipClosing {
 public:
  /// Keeps references to the hand. Takes fingers and places from grasp.fingertips.
  FingertipClosing(const hand::Hand& hand, const Grasp& grasp);

  bool is_empty() const { return tips_.empty(); }

  /// Joint rates, rad per mm that every fingertip goes into the product; `sign` is -1 where the
  /// hand opens.
  hand::Posture rate(const hand::Posture& posture, const geometry::Rigid3& product_from_hand,
                     double sign) const;

 private:
  struct Tip {
    hand::Segment segment{};
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< of the product, product frame
  };
  const hand::Hand* hand_;
  std::vector<Tip> tips_;
};

}  // namespace palmar::grasp
