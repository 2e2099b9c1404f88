// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "palmar/geometry/rigid3.h"
#include "palmar/hand/posture.h"
#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::grasp {

/// Angles of the digits, digit by digit in the order of digit_dofs().
inline constexpr int kGripJoints = hand::kFingerCount * hand::kDigitDofs;
hand::Dof grip_dof(int joint);
inline hand::Finger grip_finger(int joint) {
  return static_cast<hand::Finger>(joint / hand::kDigitDofs);
}
/// The joint that the angle belongs to.
hand::JointId grip_joint_id(int joint);

/// Generalised coordinates of a grasp: the angles [rad], then the product's motion in the hand
/// frame: translation of the centre of contact [mm] and rotation about it [rad].
inline constexpr int kGripCoordinates = kGripJoints + 6;
using GripVector = Eigen::Matrix<double, kGripCoordinates, 1>;
using GripMatrix = Eigen::Matrix<double, kGripCoordinates, kGripCoordinates>;

struct GripState {
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
};

/// The state after a motion; `centre`: of contact, hand frame, mm.
GripState moved(const GripState& from, const GripVector& way, const Vec3& centre);

}  // namespace palmar::grasp
