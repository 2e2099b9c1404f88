// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/tendons/digit_tendons.h"

namespace palmar::effort {

/// What one loaded tendon does at the tip of a finger that is held still.
struct FingertipForce {
  hand::Finger finger = hand::Finger::kIndex;
  hand::Tendon tendon = hand::Tendon::kFdp;
  double tendon_force = 0.0;                      ///< N
  std::array<hand::Dof, hand::kDigitDofs> dof{};  ///< from the palm outwards
  std::array<double, hand::kDigitDofs>
      moment_arm{};           ///< of the tendon, mm, positive in the angle's sense
  Vec3 force = Vec3::Zero();  ///< of the fingertip on what holds it, hand frame, N
  /// The same along radial, distal and palmar of the distal phalanx, N.
  Vec3 force_in_phalanx = Vec3::Zero();
  double moment = 0.0;        ///< on what holds it, about the last flexion axis, N mm
  Vec3 point = Vec3::Zero();  ///< the fingertip, where force and moment act; hand frame, mm
};

/// The tendon's moments tau_k = F r_k are balanced by what holds the distal phalanx, so that the
/// finger gives force f and moment m about its last flexion axis e with
///
///     f . (d tip / d angle_k) + m (omega_k . e) = tau_k,   k = 1 ... 4:
///
/// four equations, four unknowns. A load cell in which the phalanx is fixed takes that moment too,
/// as in the set-ups of cadaver experiments (Synek et al. 2019; Pearlman et al. 2004); a fingertip
/// that only touches could not be held still by one tendon. In the plane of flexion f does not
/// depend on where the phalanx is held; across it (abduction) it acts at the fingertip. No friction
/// of the tendon, no weight, no stiffness of joints.
///
/// The posture is used as it is. Throws UsageError for a tendon not of that finger or a force that
/// is not positive, NumericalError where the finger is so straight that a force along it meets no
/// resistance in any joint.
FingertipForce fingertip_force(const hand::Hand& hand, const hand::DigitTendons& tendons,
                               const hand::Posture& posture, hand::Tendon tendon,
                               double tendon_force);

/// Largest tendon force taken, N: more than any muscle of the hand gives.
constexpr double kLargestTendonForce = 1000.0;

}  // namespace palmar::effort
