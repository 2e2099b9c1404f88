// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// What the saddle joint of a hand without measured limit postures is made from.
///
/// Two skew axes, hand frame of a right hand: flexion/extension fixed to the trapezium,
/// abduction/adduction to the metacarpal (Hollister et al. 1992). Directions and offset from
/// Mirakhorlo et al. 2016, supplement table 3 (one specimen; angle between the axes 85 degrees,
/// 5.5 mm apart; Chang & Pollard 2008: 87 degrees, 4.6 mm).
///
/// Flexion (+) carries the metacarpal across the palm, abduction (+) out of its plane.
/// Zero of flexion: the reference posture. Zero of abduction: metacarpal in the plane of the palm.
struct CmcAxes {
  Vec3 flexion_axis{-0.27, -0.64, 0.72};
  Vec3 abduction_axis{0.78, -0.61, -0.13};
  Vec3 abduction_offset{0.6, 1.6, 6.5};  ///< of the abduction axis from the joint centre, mm
};

/// Joint kThumbCmc (two degrees of freedom, with ranges) for a metacarpal from `centre` to `mp`.
Joint make_cmc_joint(const Vec3& centre, const Vec3& mp, const CmcAxes& axes = {});

/// Limit postures at the ends of the joint's ranges: rotation about each axis.
ThumbCmc make_cmc_limits(const Joint& cmc);

}  // namespace palmar::hand
