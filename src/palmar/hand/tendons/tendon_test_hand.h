// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// A hand with known measures for the tests of this module: four equal straight fingers along y, and
// a thumb; one skin vertex in the middle of every phalanx.

#include <random>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/tendons/digit_pose.h"
#include "palmar/hand/tendons/digit_tendons.h"

namespace palmar::hand::effort_test {

/// Middle phalanx link of the fingers that Synek et al. 2019 tested, mm.
inline constexpr double kLink = 23.63;
inline constexpr double kProximal = 47.0, kMiddle = 1.22 * kLink, kDistal = 26.0;  // mm

inline JointDof hinge(Dof dof, const Vec3& axis, const Vec3& centre, double lower, double upper) {
  JointDof result;
  result.dof = dof;
  result.axis = axis.normalized();
  result.centre = centre;
  result.lower = lower * geometry::kDegree;
  result.upper = upper * geometry::kDegree;
  return result;
}

inline Dof dof_of(Finger finger, const char* joint) {
  return *dof_named(std::string(name_of(finger)) + "_" + joint);
}

/// scale: of all lengths.
inline Hand plain_hand(double scale = 1.0) {
  Hand hand;
  hand.name = "plain";
  Skeleton& skeleton = hand.skeleton;
  for (int j = 0; j < kJointCount; ++j) {
    skeleton.joints[j].id = static_cast<JointId>(j);
  }
  const auto joint = [&](JointId id) -> Joint& { return skeleton.joints[index_of(id)]; };
  joint(JointId::kWrist).dofs = {
      hinge(Dof::kWristFlexion, Vec3::UnitX(), Vec3::Zero(), -70, 70),
      hinge(Dof::kWristDeviation, -Vec3::UnitZ(), Vec3::Zero(), -30, 20),
      hinge(Dof::kWristPronation, -Vec3::UnitY(), Vec3::Zero(), -80, 80)};
  const auto place = [&](JointId id, const Vec3& centre) { joint(id).centre = scale * centre; };
  for (const Finger finger : {Finger::kIndex, Finger::kMiddle, Finger::kRing, Finger::kLittle}) {
    const auto segments = segments_of(finger);
    const double x = 20.0 - 20.0 * (static_cast<int>(finger) - 1);
    double y = 90.0;
    const JointId mcp = joint_of(*segments[0]), pip = joint_of(*segments[1]),
                  dip = joint_of(*segments[2]);
    place(mcp, {x, y, 0.0});
    place(pip, {x, y += kProximal, 0.0});
    place(dip, {x, y += kMiddle, 0.0});
    skeleton.fingertips[index_of(finger)] = scale * Vec3(x, y + kDistal, 0.0);
    joint(mcp).dofs = {
        hinge(dof_of(finger, "mcp_abduction"), -Vec3::UnitZ(), joint(mcp).centre, -30, 30),
        hinge(dof_of(finger, "mcp_flexion"), Vec3::UnitX(), joint(mcp).centre, -30, 90)};
    joint(pip).dofs = {
        hinge(dof_of(finger, "pip_flexion"), Vec3::UnitX(), joint(pip).centre, 0, 110)};
    joint(dip).dofs = {
        hinge(dof_of(finger, "dip_flexion"), Vec3::UnitX(), joint(dip).centre, -10, 80)};
  }
  place(JointId::kThumbCmc, {28.0, 22.0, 15.0});
  place(JointId::kThumbMp, {42.0, 58.0, 32.0});
  place(JointId::kThumbIp, {58.0, 82.0, 42.0});
  skeleton.fingertips[0] = scale * Vec3(72.0, 104.0, 48.0);
  joint(JointId::kThumbCmc).dofs = {hinge(Dof::kThumbCmcAbduction, {0.78, -0.61, -0.13},
                                          joint(JointId::kThumbCmc).centre, -30, 30),
                                    hinge(Dof::kThumbCmcFlexion, {-0.27, -0.64, 0.72},
                                          joint(JointId::kThumbCmc).centre, -25, 25)};
  const auto turned = [](const Vec3& axis, double angle) {
    return CmcLimit{Quat(Eigen::AngleAxisd(angle * geometry::kDegree, axis.normalized())),
                    Vec3::Zero()};
  };
  skeleton.thumb_cmc = {turned({-0.27, -0.64, 0.72}, 25), turned({-0.27, -0.64, 0.72}, -25),
                        turned({0.78, -0.61, -0.13}, 30), turned({0.78, -0.61, -0.13}, -30)};
  const Vec3 thumb_axis(0.1, -0.45, 0.88);
  joint(JointId::kThumbMp).dofs = {
      hinge(Dof::kThumbMpFlexion, thumb_axis, joint(JointId::kThumbMp).centre, -10, 60)};
  joint(JointId::kThumbIp).dofs = {
      hinge(Dof::kThumbIpFlexion, thumb_axis, joint(JointId::kThumbIp).centre, -10, 80)};

  for (int s = 1; s < kSegmentCount; ++s) {
    const auto segment = static_cast<Segment>(s);
    const Finger finger = *finger_of(segment);
    const auto segments = segments_of(finger);
    Vec3 end = skeleton.fingertips[index_of(finger)];
    for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
      if (segments[i] == segment && segments[i + 1]) {
        end = joint(joint_of(*segments[i + 1])).centre;
      }
    }
    hand.skin.vertices.push_back(0.5 * (joint(joint_of(segment)).centre + end));
    hand.segment.push_back(segment);
    hand.region.push_back(*region_of(segment));
    hand.dimensions.segment[s] = {25.0 * scale, 16.0 * scale, 14.0 * scale};
  }
  return hand;
}

/// The skin vertex of a phalanx.
inline int vertex_of(Segment segment) { return static_cast<int>(segment) - 1; }

inline Posture posture_of(Finger finger, double mcp, double pip, double dip, double abduction = 0) {
  Posture posture;
  posture[dof_of(finger, "mcp_flexion")] = mcp * geometry::kDegree;
  posture[dof_of(finger, "mcp_abduction")] = abduction * geometry::kDegree;
  posture[dof_of(finger, "pip_flexion")] = pip * geometry::kDegree;
  posture[dof_of(finger, "dip_flexion")] = dip * geometry::kDegree;
  return posture;
}

/// Every angle of the digit somewhere inside its range.
inline Posture random_posture(const Skeleton& skeleton, Finger finger, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.05, 0.95);
  Posture posture = reference_posture(skeleton);
  for (const Dof dof : pose_digit(skeleton, finger, posture).dof) {
    const JointDof& joint = skeleton.dof(dof);
    posture[dof] = joint.lower + share(random) * (joint.upper - joint.lower);
  }
  return posture;
}

inline constexpr std::array<Finger, kFingerCount> kFingers = {
    Finger::kThumb, Finger::kIndex, Finger::kMiddle, Finger::kRing, Finger::kLittle};

}  // namespace palmar::hand::effort_test
