// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/ligaments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::grasp {
namespace {

constexpr double kLongestRise = 8.0;  // e-folds of a moment, beyond which it stays

}  // namespace

hand::PassiveMoments ligament_moments(const hand::Skeleton& skeleton, hand::Finger finger,
                                      const hand::Posture& posture, const hand::Posture& start,
                                      const LigamentModel& model) {
  hand::PassiveMoments result;
  const bool is_finger = finger != hand::Finger::kThumb;
  const std::array<hand::Dof, hand::kDigitDofs> dofs = hand::digit_dofs(finger);
  for (int k = 0; k < hand::kDigitDofs; ++k) {
    const hand::JointDof& dof = skeleton.dof(dofs[static_cast<std::size_t>(k)]);
    const double angle = posture[dof.dof];
    const auto push = [&](double beyond, double sense) {
      const double rise = std::min(kLongestRise, beyond / model.stop_rise);
      const double moment = model.stop_moment * std::exp(rise);
      result.moment[k] += sense * moment;
      if (rise < kLongestRise) result.stiffness(k, k) += moment / model.stop_rise;
    };
    push(dof.lower - angle, 1.0);
    if (!is_finger || !hand::is_flexion(dof.dof)) push(angle - dof.upper, -1.0);
  }
  if (!is_finger) return result;
  constexpr Eigen::Index kFlexion = 0, kAbduction = 1;
  const double width = model.tight_to - model.tight_from;
  const double t = std::clamp((posture[dofs[0]] - model.tight_from) / width, 0.0, 1.0);
  const double tight = model.tight_stiffness * t * t * (3.0 - 2.0 * t);
  const double off = posture[dofs[1]] - start[dofs[1]];
  result.moment[kAbduction] -= tight * off;
  result.stiffness(kAbduction, kAbduction) += tight;
  result.stiffness(kAbduction, kFlexion) +=
      model.tight_stiffness * 6.0 * t * (1.0 - t) / width * off;
  return result;
}

}  // namespace palmar::grasp
