// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::hand {

/// How far muscles and product can bend a finger beyond its active range, at most; the passive
/// moment there is half of what muscles can give. rad; our choice.
inline constexpr double kPassiveRange = 0.524;

/// What a digit's ligaments, skin and slack muscles do in a posture, without muscle force.
struct PassiveMoments {
  Eigen::Vector4d moment = Eigen::Vector4d::Zero();     ///< in the angles' sense, N mm
  Eigen::Matrix4d stiffness = Eigen::Matrix4d::Zero();  ///< -d moment / d angle, N mm/rad
};

/// How ligaments end a range; the figures are our choice.
struct LigamentModel {
  /// Moment at the end of a range, N mm, and the angle over which it grows e-fold, rad (3.4
  /// degrees).
  double stop_moment = 500.0, stop_rise = 0.06;
  /// Flexion of a finger's MCP at which its collateral ligaments leave no abduction, rad; from
  /// straight to there its range shrinks in proportion (a rule of models of the hand; laxity under
  /// a load falls from 24 degrees to 15 at 90, Lutsky et al. 2014, J Hand Surg 39A:1088, abstract).
  double no_abduction = 1.5708;
};

/// Flexion of a finger's MCP joint, as measured on an index finger with the wrist straight
/// (Deshpande, Gialias & Matsuoka 2012, IEEE Trans Biomed Eng 59:586-594; one man, at second hand):
///
///     M = A (exp(-B (q - E)) - 1) - C (exp(D (q - F)) - 1)
///
/// counted from the end of that finger's active range where its own differs from 84.7 degrees
/// (Latz et al. 2019). PIP and DIP: its second term from as far before the end of their ranges, as
/// none is published for them that we know of (our choice). DIP and PIP are coupled: beyond 10
/// degrees from DIP = 2/3 PIP (Rijkpema & Girard 1991) 1.5 N m/rad pull them back (our choice). All
/// other ends of ranges: LigamentModel. Moments and stiffness are those of one energy.
PassiveMoments passive_moments(const Skeleton& skeleton, Finger finger, const Posture& posture,
                               const LigamentModel& ligaments = {});

/// Ligaments of hands that aren't at rest, for which passive_moments() would hold more than acts.
struct JointStops {
  bool is_on = true;  ///< a joint at the end of its range is held there by its ligaments
  /// Collateral ligaments of a finger's MCP are tight when it is bent: from this flexion on they
  /// take moments of abduction, both ways. rad (60 degrees); our choice.
  double tight_mcp_flexion = 1.0472;
  double margin = 0.00873;  ///< rad (0.5 degrees); this near the end counts as at the end
};

/// How ligaments can push an angle, in the posture: +1 up, -1 down, 2 both ways, 0 not at all. The
/// upper end of a finger's flexion is no stop: passive_moments() rise there.
int stop_of(const Skeleton& skeleton, Dof which, const Posture& posture, const JointStops& stops);

}  // namespace palmar::hand
