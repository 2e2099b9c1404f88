// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/anatomy.h"
#include "palmar/hand/posture.h"

namespace palmar::hand {

/// One degree of freedom of a joint. Turning by (angle - reference) about `axis` through `centre`
/// moves everything distal to the joint; all in the hand frame, reference posture.
struct JointDof {
  Dof dof{};
  Vec3 axis = Vec3::UnitX();   ///< unit; right-handed about it is the positive anatomical sense
  Vec3 centre = Vec3::Zero();  ///< a point on the axis, mm
  double reference = 0.0;      ///< angle of the skin's reference posture, rad
  double lower = 0.0;          ///< range of motion, rad
  double upper = 0.0;
  std::string source;  ///< where axis and range come from (author, year)
};

/// Displacement of the thumb metacarpal from the reference posture to one limit posture (Xie 2014,
/// eq. 2-5, 2-6): v' = c + q (v - c) + t, axes of the hand frame, origin c = centre of the CMC
/// joint. The origin matters for what lies between the limits: t and q are interpolated apart, and
/// only near the joint does that leave the base of the metacarpal on the trapezium.
struct CmcLimit {
  Quat q = Quat::Identity();
  Vec3 t = Vec3::Zero();  ///< mm
};

/// The saddle joint of the thumb has no single axis: in between the four limit postures the
/// metacarpal follows q = exp(s_fe log q_fe + s_aa log q_aa), t = s_fe t_fe + s_aa t_aa; the sign
/// of s picks the limit posture (flexion or extension, abduction or adduction) and |s| = 1 reaches
/// it.
struct ThumbCmc {
  CmcLimit flexion, extension, abduction, adduction;
};

struct Joint {
  JointId id{};
  Vec3 centre = Vec3::Zero();  ///< hand frame, reference posture, mm
  std::vector<JointDof> dofs;  ///< in the order in which they are applied, most distal axis first
};

/// Joints of one hand in the hand frame (x radial, y distal, z palmar for a right hand;
/// origin at the wrist joint centre), reference posture.
struct Skeleton {
  std::array<Joint, kJointCount> joints;
  ThumbCmc thumb_cmc;
  std::array<Vec3, kFingerCount> fingertips;  ///< most distal skin point of each finger, mm

  const Joint& joint(JointId id) const { return joints[index_of(id)]; }
  const JointDof& dof(Dof d) const;
};

/// The posture in which the skin was measured or modelled.
Posture reference_posture(const Skeleton& skeleton);

/// One angle that was outside its range of motion.
struct ClampedAngle {
  Dof dof{};
  double asked = 0.0;  ///< rad
  double used = 0.0;   ///< rad
};

struct ClampedPosture {
  Posture posture;
  std::vector<ClampedAngle> clamped;  ///< empty if the posture was inside the range of motion
};

/// Holds a posture to the range of motion and says which angles it changed.
ClampedPosture clamp_to_range(const Skeleton& skeleton, const Posture& posture);

/// Where each rigid part stands in a posture: posed_from_reference for the palm (identity, the hand
/// frame is fixed to the palm), the 14 phalanges, the thumb metacarpal and the forearm.
struct PosedSkeleton {
  std::array<geometry::Rigid3, kSegmentCount> segment;  ///< indexed by Segment
  geometry::Rigid3 thumb_metacarpal;
  geometry::Rigid3 forearm;
};

/// How far along its four limit postures the CMC joint stands: s_fe > 0 towards flexion, s_aa > 0
/// towards abduction, |s| = 1 at the limit.
struct CmcShare {
  double s_fe = 0.0, s_aa = 0.0;
};
CmcShare cmc_share(const Skeleton& skeleton, const Posture& posture);

/// One axis of a joint turned to its angle, as a displacement from the reference posture.
geometry::Rigid3 axis_displacement(const JointDof& dof, const Posture& posture);

/// Displacement of the thumb metacarpal for shares of the limit postures (eq. 2-5, 2-6, both at
/// once), hand frame.
geometry::Rigid3 cmc_displacement(const Skeleton& skeleton, const CmcShare& share);

/// Forward kinematics. Angles are used as they are; clamp first.
PosedSkeleton pose_skeleton(const Skeleton& skeleton, const Posture& posture);

}  // namespace palmar::hand
