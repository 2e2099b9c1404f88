// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/subject_joints.h"

#include <cmath>

namespace palmar::phantom {
namespace {

geometry::Rigid3 about(const Vec3& axis, const Vec3& point, double angle) {
  return geometry::Rigid3::about_axis(axis, point, angle);
}

}  // namespace

geometry::Rigid3 joint_motion(const RollingJoint& joint, const hand::Posture& posture) {
  const double f = posture[joint.flexion], f0 = joint.reference;
  const auto h = [&](double flexion) {
    return std::hypot(std::cos(flexion), (1.0 + joint.ellipse) * std::sin(flexion));
  };
  const Vec3& c = joint.centre;
  geometry::Rigid3 turn =
      about(joint.axis, c, f - f0) * about(joint.along, c, joint.twist * (f - f0));
  const Vec3 e = turn.rotation * joint.along;
  const Vec3 n = turn.rotation * joint.axis.cross(joint.along);
  turn.translation +=
      joint.radius * (h(f) - h(f0)) * e + joint.creep * (std::sin(f) - std::sin(f0)) * n;
  if (!joint.abduction) return turn;
  return turn * about(joint.abduction_axis, joint.abduction_point,
                      posture[*joint.abduction] - joint.abduction_reference);
}

geometry::Rigid3 joint_motion(const SaddleJoint& joint, const hand::Posture& posture) {
  const double f = posture[hand::Dof::kThumbCmcFlexion] - joint.flexion_reference;
  const double a = posture[hand::Dof::kThumbCmcAbduction] - joint.abduction_reference;
  const double pronation = joint.by_flexion * f + joint.by_abduction * a + joint.by_both * f * a;
  const auto screw = [&](const Vec3& axis, const Vec3& point, double angle) {
    geometry::Rigid3 turn = about(axis, point, angle);
    turn.translation += joint.glide * angle * axis;
    return turn;
  };
  return screw(joint.flexion_axis, joint.centre, f) * about(joint.along, joint.centre, pronation) *
         screw(joint.abduction_axis, joint.abduction_point, a);
}

std::optional<int> parent_of(int body) {
  if (body == static_cast<int>(hand::Segment::kPalm)) return {};
  if (body == kThumbMetacarpalBody) return static_cast<int>(hand::Segment::kPalm);
  if (body == static_cast<int>(hand::Segment::kThumbProximal)) return kThumbMetacarpalBody;
  const hand::Finger finger = *hand::finger_of(static_cast<hand::Segment>(body));
  const bool is_first = hand::segments_of(finger)[0] == static_cast<hand::Segment>(body);
  return is_first ? static_cast<int>(hand::Segment::kPalm) : body - 1;
}

std::array<geometry::Rigid3, kBodyCount> body_motions(const SubjectJoints& joints,
                                                      const hand::Posture& posture) {
  std::array<geometry::Rigid3, kBodyCount> motion;
  motion[kThumbMetacarpalBody] = joint_motion(joints.cmc, posture);
  // Segments stand from proximal to distal, so a parent comes first.
  for (int body = 1; body < hand::kSegmentCount; ++body) {
    motion[body] = motion[*parent_of(body)] * joint_motion(joints.phalanx[body], posture);
  }
  return motion;
}

InstantAxis instant_axis(const SubjectJoints& joints, const hand::Posture& reference, int body,
                         hand::Dof dof) {
  constexpr double kStep = 1.0e-5;  // rad
  const bool is_cmc = body == kThumbMetacarpalBody;
  const auto motion = [&](double step) {
    hand::Posture posture = reference;
    posture[dof] += step;
    return is_cmc ? joint_motion(joints.cmc, posture) : joint_motion(joints.phalanx[body], posture);
  };
  const Vec3& centre = is_cmc ? joints.cmc.centre : joints.phalanx[body].centre;
  const geometry::Rigid3 step = motion(kStep) * motion(-kStep).inverse();
  const Vec3 turn = 2.0 * step.rotation.vec() / (2.0 * kStep);     // per rad
  const Vec3 velocity = (step * centre - centre) / (2.0 * kStep);  // mm per rad
  return {turn.normalized(), centre + turn.cross(velocity) / turn.squaredNorm()};
}

}  // namespace palmar::phantom
