// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skeleton.h"

namespace palmar::phantom {

/// Rigid parts of a subject: the palm and the 14 phalanges by their Segment, then the thumb's
/// metacarpal.
inline constexpr int kThumbMetacarpalBody = hand::kSegmentCount;
inline constexpr int kBodyCount = hand::kSegmentCount + 1;

/// Joint of a phalanx that rolls and glides on an elliptic head. Hand frame, reference posture.
///
/// For a flexion f (from straight) the phalanx turns about `axis` by f - reference and about its
/// own length by `twist` times that; its end of the joint follows the head, whose sagittal section
/// has half axes R along the proximal bone and (1 + ellipse) R across it, and creeps palmarly:
///   c(f) = c + R (h(f) - h(f0)) e(f) + creep (sin f - sin f0) n(f),
///   h(f) = sqrt(cos^2 f + (1 + ellipse)^2 sin^2 f),
/// e along the phalanx, n its palmar direction, f0 the reference. So no axis is fixed. Abduction
/// happens first, about an axis that the phalanx carries.
struct RollingJoint {
  hand::Dof flexion{};
  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitX();   ///< of flexion
  Vec3 along = Vec3::UnitY();  ///< of the phalanx
  double radius = 5.0;         ///< R, mm
  double ellipse = 0.0, twist = 0.0;
  double creep = 0.0;  ///< mm
  double reference = 0.0;
  std::optional<hand::Dof> abduction;
  Vec3 abduction_axis = Vec3::UnitZ(), abduction_point = Vec3::Zero();
  double abduction_reference = 0.0;
};

/// Saddle joint: flexion about an axis of the trapezium, abduction about one of the metacarpal,
/// some millimetres apart and not square (Hollister et al. 1992), and between them a turn of the
/// metacarpal about its own length that both bring about: pronation = by_flexion f + by_abduction a
/// + by_both f a, angles from the reference posture. Each turn is a screw: the metacarpal glides by
/// glide f and glide a along the axes (turns come with translation: Crisco et al. 2015).
struct SaddleJoint {
  Vec3 centre = Vec3::Zero();
  Vec3 flexion_axis = Vec3::UnitZ(), abduction_axis = Vec3::UnitX();
  Vec3 abduction_point = Vec3::Zero();
  Vec3 along = Vec3::UnitY();  ///< of the metacarpal
  double by_flexion = 0.0, by_abduction = 0.0, by_both = 0.0;
  double glide = 0.0;  ///< mm per rad
  double flexion_reference = 0.0, abduction_reference = 0.0;
};

struct SubjectJoints {
  SaddleJoint cmc;
  std::array<RollingJoint, hand::kSegmentCount> phalanx;  ///< by Segment; that of the palm isn't
                                                          ///< used
};

/// posed_from_reference of a phalanx against the next more proximal part, both in the frame of the
/// reference posture.
geometry::Rigid3 joint_motion(const RollingJoint& joint, const hand::Posture& posture);
geometry::Rigid3 joint_motion(const SaddleJoint& joint, const hand::Posture& posture);

/// posed_from_reference of every part, the palm standing still. Quaternions along a finger turn
/// without a jump of sign.
std::array<geometry::Rigid3, kBodyCount> body_motions(const SubjectJoints& joints,
                                                      const hand::Posture& posture);

/// The part that carries a body; nothing for the palm.
std::optional<int> parent_of(int body);

/// Where the joint turns at the reference posture if `dof` alone begins to change: direction and
/// point (nearest to the joint's centre) of the instantaneous axis, hand frame.
struct InstantAxis {
  Vec3 axis, point;
};
InstantAxis instant_axis(const SubjectJoints& joints, const hand::Posture& reference, int body,
                         hand::Dof dof);

}  // namespace palmar::phantom
