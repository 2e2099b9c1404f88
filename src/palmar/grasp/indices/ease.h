// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "palmar/grasp/indices/coordination.h"
#include "palmar/grasp/indices/grasp_index.h"

namespace palmar::grasp {

/// How easy a posture is to take and keep: by how the joints of natural grasps go together, and by
/// the distance of each joint from the middle of its range.
struct EaseResult {
  CoordinationDistance coordination;
  CoordinationBasis basis;  ///< that was used
  /// |angle - middle| / half the range of motion: 0 in the middle, 1 at either end; above 1 beyond.
  std::array<double, kDigitDofCount> from_middle{};
  double from_middle_rms = 0.0;                      ///< over the 20 joint angles
  hand::Dof farthest = hand::Dof::kThumbCmcFlexion;  ///< nearest to an end of its range, or beyond
  double farthest_share = 0.0;                       ///< its distance from the middle
  int at_limit = 0;  ///< joint angles within 1 deg of an end of their range, or beyond
};

/// Joints of the digits only: the wrist doesn't count. A joint whose range is less than 1 deg wide
/// doesn't count either.
EaseResult assess_ease(const hand::Skeleton& skeleton, const hand::Posture& posture,
                       const CoordinationBasis& basis);

/// Rows of the group "ease".
GraspIndices to_indices(const EaseResult& result);

}  // namespace palmar::grasp
