// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/posture.h"
#include "palmar/hand/tendons/joint_limits.h"

namespace palmar::grasp {

/// Ligaments that hand::passive_moments() leaves out, as moments without a step in place of
/// hand::JointStops; the figures are our choice.
struct LigamentModel {
  /// At the end of a range: moment there, N mm, and the angle over which it grows e-fold, rad (3.4
  /// degrees). The upper end of a finger's flexion is passive_moments()'.
  double stop_moment = 500.0, stop_rise = 0.06;
  /// Collateral ligaments of an MCP tighten between these angles of its flexion (45 and 75
  /// degrees), rad; they resist abduction from where it was by that stiffness, N mm/rad.
  double tight_from = 0.7854, tight_to = 1.309, tight_stiffness = 10000.0;
};

/// Moments about the angles of one digit and their stiffness; `start`: the posture that abduction
/// counts from.
hand::PassiveMoments ligament_moments(const hand::Skeleton& skeleton, hand::Finger finger,
                                      const hand::Posture& posture, const hand::Posture& start,
                                      const LigamentModel& model = {});

}  // namespace palmar::grasp
