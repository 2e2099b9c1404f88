// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::hand {
namespace {

constexpr double kStep = 1e-4;  // rad; error of the difference below 1e-8, rounding below 1e-9

Twist hinge(const JointDof& dof, const geometry::Rigid3& proximal) {
  const Vec3 axis = proximal.rotation * dof.axis;
  return {axis, -axis.cross(proximal * dof.centre)};
}

Twist rate_of_cmc(const Skeleton& skeleton, const Posture& posture, Dof dof) {
  Posture plus = posture, minus = posture;
  plus[dof] += kStep;
  minus[dof] -= kStep;
  const geometry::Rigid3 after = cmc_displacement(skeleton, cmc_share(skeleton, plus));
  const geometry::Rigid3 before = cmc_displacement(skeleton, cmc_share(skeleton, minus));
  const Eigen::AngleAxisd turn(after.rotation * before.rotation.conjugate());
  const Vec3 omega = turn.angle() * turn.axis() / (2.0 * kStep);
  const Vec3 middle = 0.5 * (after.translation + before.translation);
  const Vec3 rate = (after.translation - before.translation) / (2.0 * kStep);
  return {omega, rate - omega.cross(middle)};
}

}  // namespace

int body_count(Finger finger) { return finger == Finger::kThumb ? 4 : 5; }
int distal_body(Finger finger) { return body_count(finger) - 1; }

PosedDigit pose_digit(const Skeleton& skeleton, Finger finger, const Posture& posture) {
  PosedDigit digit;
  digit.finger = finger;
  std::size_t k = 0;
  int body = 0;
  geometry::Rigid3 displacement;
  if (finger == Finger::kThumb) {
    displacement = cmc_displacement(skeleton, cmc_share(skeleton, posture));
    for (const Dof dof : {Dof::kThumbCmcFlexion, Dof::kThumbCmcAbduction}) {
      digit.dof[k] = dof;
      digit.twist[k] = rate_of_cmc(skeleton, posture, dof);
      digit.moves[k++] = 1;
    }
    digit.body[++body] = displacement;
  }
  for (const auto& segment : segments_of(finger)) {
    if (!segment) continue;
    const Joint& joint = skeleton.joint(joint_of(*segment));
    // The dofs of a joint are listed from its most distal axis.
    for (auto dof = joint.dofs.rbegin(); dof != joint.dofs.rend(); ++dof) {
      digit.dof[k] = dof->dof;
      digit.twist[k] = hinge(*dof, displacement);
      displacement = displacement * axis_displacement(*dof, posture);
      digit.moves[k++] = ++body;
      digit.body[body] = displacement;
    }
  }
  return digit;
}

int body_of(Segment segment) {
  const auto finger = finger_of(segment);
  if (!finger) return 0;
  int body = body_count(*finger);
  const auto segments = segments_of(*finger);
  for (auto s = segments.rbegin(); s != segments.rend(); ++s) {
    if (!*s) continue;
    --body;
    if (**s == segment) return body;
  }
  return 0;
}

namespace {
constexpr int kFirstDof = static_cast<int>(Dof::kThumbCmcFlexion);
}

std::array<Dof, kDigitDofs> digit_dofs(Finger finger) {
  std::array<Dof, kDigitDofs> dofs{};
  for (int k = 0; k < kDigitDofs; ++k) {
    dofs[k] = static_cast<Dof>(kFirstDof + kDigitDofs * static_cast<int>(finger) + k);
  }
  return dofs;
}

Finger finger_of(Dof dof) {
  return static_cast<Finger>((static_cast<int>(dof) - kFirstDof) / kDigitDofs);
}

bool is_flexion(Dof dof) { return name_of(dof).ends_with("flexion"); }

}  // namespace palmar::hand
