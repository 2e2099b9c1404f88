// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/grasp/equilibrium/skin_motion.h"
#include "palmar/grasp/power/finger_cones.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// Parts of the hand that lie on what a power grip holds: the 14 phalanges in the order of
/// hand::Segment, then the pads below index and middle finger, below ring and little finger, and
/// the hypothenar.
inline constexpr int kVolarParts = hand::kSegmentCount - 1 + 3;
using VolarVector = Eigen::Matrix<double, kVolarParts, 1>;
using VolarRates = Eigen::Matrix<double, kVolarParts, kGripCoordinates>;

/// How far the volar skin of each part is from a product; the thumb's from the product or from a
/// finger that it lies on.
class VolarGaps {
 public:
  /// Keeps references. Skin is that of the coarse hand.
  VolarGaps(const contact::PreparedHand& hand, const product::Product& product);

  /// Gap of each part, mm: mean distance of its volar skin, nearer skin counting more,
  ///
  ///     -t ln sum_v s_v exp(-d_v / t),   t = 3 mm (our choice)
  ///
  /// s_v the share of skin that speaks for the volar side: its area, in a phalanx times the fourth
  /// power of the cosine between its direction from the bone and the volar one. Smooth; negative
  /// where skin lies in the product. `posed`: the coarse skin in the state's posture, hand frame.
  VolarVector look(const GripState& state, const std::vector<Vec3>& posed);

  /// How coordinates change the gaps of the state last looked at, mm per mm and rad; `centre`: of
  /// contact, hand frame, mm.
  VolarRates rates(const GripState& state, const std::vector<Vec3>& posed,
                   const Vec3& centre) const;

 private:
  struct Skin {
    int vertex = 0, part = 0;
    double share = 0.0;  ///< in its part
    // Of the state last looked at.
    double weight = 0.0;          ///< d gap / d distance
    Vec3 normal = Vec3::Zero();   ///< away from what is nearest, hand frame
    hand::Finger finger{};        ///< that is nearer than the product, if `body` isn't 0
    int body = 0;                 ///< of that finger
    Vec3 touched = Vec3::Zero();  ///< point of that finger, hand frame, mm
  };

  const hand::Hand* hand_;
  SkinMotion motion_;
  const product::Product* product_;
  FingerCones cones_;
  std::vector<Skin> skin_;
  std::vector<int> vertex_;                       ///< of skin_
  std::vector<geometry::DistanceSample> sample_;  ///< of the state last looked at
};

}  // namespace palmar::grasp
