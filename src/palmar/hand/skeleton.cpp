// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skeleton.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

geometry::Rigid3 turned(const Joint& joint, const Posture& posture) {
  geometry::Rigid3 displacement;
  for (const JointDof& dof : joint.dofs)
    displacement = axis_displacement(dof, posture) * displacement;
  return displacement;
}

double share_of(const JointDof& dof, double angle) {
  const double turn = angle - dof.reference;
  const double limit = turn >= 0 ? dof.upper - dof.reference : dof.reference - dof.lower;
  return limit > 0 ? turn / limit : 0.0;
}

Vec3 rotation_vector(const Quat& q) {
  const Eigen::AngleAxisd turn(q);
  return turn.angle() * turn.axis();
}

}  // namespace

geometry::Rigid3 axis_displacement(const JointDof& dof, const Posture& posture) {
  return geometry::Rigid3::about_axis(dof.axis, dof.centre, posture[dof.dof] - dof.reference);
}

const JointDof& Skeleton::dof(Dof d) const {
  for (const Joint& joint : joints) {
    for (const JointDof& dof : joint.dofs) {
      if (dof.dof == d) return dof;
    }
  }
  throw Error("skeleton: degree of freedom \"" + std::string(name_of(d)) + "\" is missing");
}

Posture reference_posture(const Skeleton& skeleton) {
  Posture posture;
  for (const Joint& joint : skeleton.joints) {
    for (const JointDof& dof : joint.dofs) posture[dof.dof] = dof.reference;
  }
  return posture;
}

ClampedPosture clamp_to_range(const Skeleton& skeleton, const Posture& posture) {
  ClampedPosture result{posture, {}};
  for (int i = 0; i < kDofCount; ++i) {
    const auto d = static_cast<Dof>(i);
    const JointDof& dof = skeleton.dof(d);
    const double asked = posture[d];
    const double used = std::clamp(asked, dof.lower, dof.upper);
    if (used == asked) continue;
    result.posture[d] = used;
    result.clamped.push_back({d, asked, used});
  }
  return result;
}

CmcShare cmc_share(const Skeleton& skeleton, const Posture& posture) {
  return {share_of(skeleton.dof(Dof::kThumbCmcFlexion), posture[Dof::kThumbCmcFlexion]),
          share_of(skeleton.dof(Dof::kThumbCmcAbduction), posture[Dof::kThumbCmcAbduction])};
}

geometry::Rigid3 cmc_displacement(const Skeleton& skeleton, const CmcShare& share) {
  const ThumbCmc& cmc = skeleton.thumb_cmc;
  const CmcLimit& fe = share.s_fe >= 0 ? cmc.flexion : cmc.extension;
  const CmcLimit& aa = share.s_aa >= 0 ? cmc.abduction : cmc.adduction;
  const double s_fe = std::abs(share.s_fe), s_aa = std::abs(share.s_aa);
  const Vec3 log_q = s_fe * rotation_vector(fe.q) + s_aa * rotation_vector(aa.q);
  const double angle = log_q.norm();
  const Quat q(angle > 0 ? Eigen::AngleAxisd(angle, log_q / angle) : Eigen::AngleAxisd::Identity());
  const Vec3& c = skeleton.joint(JointId::kThumbCmc).centre;
  return {q, c - q * c + s_fe * fe.t + s_aa * aa.t};
}

PosedSkeleton pose_skeleton(const Skeleton& skeleton, const Posture& posture) {
  PosedSkeleton posed;
  posed.forearm = turned(skeleton.joint(JointId::kWrist), posture).inverse();
  posed.thumb_metacarpal = cmc_displacement(skeleton, cmc_share(skeleton, posture));
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    geometry::Rigid3 proximal =
        finger == Finger::kThumb ? posed.thumb_metacarpal : geometry::Rigid3{};
    for (const std::optional<Segment>& segment : segments_of(finger)) {
      if (!segment) continue;
      proximal = proximal * turned(skeleton.joint(joint_of(*segment)), posture);
      posed.segment[index_of(*segment)] = proximal;
    }
  }
  return posed;
}

}  // namespace palmar::hand
