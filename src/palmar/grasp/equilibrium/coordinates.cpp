// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/coordinates.h"

#include <algorithm>
#include <array>

namespace palmar::grasp {

hand::Dof grip_dof(int joint) {
  return hand::digit_dofs(grip_finger(joint))[static_cast<std::size_t>(joint % hand::kDigitDofs)];
}

hand::JointId grip_joint_id(int joint) {
  const auto segments = hand::segments_of(grip_finger(joint));
  if (grip_finger(joint) == hand::Finger::kThumb) {
    return std::array{hand::JointId::kThumbCmc, hand::JointId::kThumbCmc, hand::JointId::kThumbMp,
                      hand::JointId::kThumbIp}[static_cast<std::size_t>(joint)];
  }
  // MCP has the first two angles.
  return hand::joint_of(
      *segments[static_cast<std::size_t>(std::max(0, joint % hand::kDigitDofs - 1))]);
}

GripState moved(const GripState& from, const GripVector& way, const Vec3& centre) {
  GripState to = from;
  for (int j = 0; j < kGripJoints; ++j) to.posture[grip_dof(j)] += way[j];
  const Vec3 turn = way.tail<3>();
  geometry::Rigid3 motion;
  if (turn.norm() > 0.0) {
    motion = geometry::Rigid3::about_axis(turn.normalized(), centre, turn.norm());
  }
  motion.translation += way.segment<3>(kGripJoints);
  to.product_from_hand = from.product_from_hand * motion.inverse();
  return to;
}

}  // namespace palmar::grasp
