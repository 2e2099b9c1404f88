// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/posture/skeleton_in_posture.h"

#include <algorithm>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

Joint& joint_at(Skeleton& skeleton, JointId id) { return skeleton.joints[index_of(id)]; }

void carry(Joint& joint, const geometry::Rigid3& before, const geometry::Rigid3& after) {
  joint.centre = before * joint.centre;
  for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
    // Of two axes the first is fixed to the distal part.
    const geometry::Rigid3& by = k + 1 < joint.dofs.size() ? after : before;
    joint.dofs[k].axis = by.rotation * joint.dofs[k].axis;
    joint.dofs[k].centre = by * joint.dofs[k].centre;
  }
}

/// Limits of the CMC joint counted from where the metacarpal is now.
void count_limits_from(const Skeleton& before, const Posture& posture, Skeleton& after) {
  const geometry::Rigid3 now = cmc_displacement(before, cmc_share(before, posture));
  const Vec3& centre = after.joint(JointId::kThumbCmc).centre;
  const CmcShare share = cmc_share(before, posture);
  const auto from_here = [&](const CmcShare& limit) {
    const geometry::Rigid3 motion = cmc_displacement(before, limit) * now.inverse();
    return CmcLimit{motion.rotation, motion * centre - centre};
  };
  after.thumb_cmc.flexion = from_here({1.0, share.s_aa});
  after.thumb_cmc.extension = from_here({-1.0, share.s_aa});
  after.thumb_cmc.abduction = from_here({share.s_fe, 1.0});
  after.thumb_cmc.adduction = from_here({share.s_fe, -1.0});
}

}  // namespace

Skeleton skeleton_in_posture(const Skeleton& skeleton, const Posture& posture) {
  const PosedSkeleton pose = pose_skeleton(skeleton, posture);
  Skeleton result = skeleton;
  carry(joint_at(result, JointId::kThumbCmc), {}, pose.thumb_metacarpal);
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    geometry::Rigid3 before = finger == Finger::kThumb ? pose.thumb_metacarpal : geometry::Rigid3{};
    for (const auto& segment : segments_of(finger)) {
      if (!segment) continue;
      const geometry::Rigid3& after = pose.segment[index_of(*segment)];
      carry(joint_at(result, joint_of(*segment)), before, after);
      before = after;
    }
    Vec3& tip = result.fingertips[f];
    tip = before * tip;
  }
  for (Joint& joint : result.joints) {
    for (JointDof& dof : joint.dofs) {
      dof.reference = posture[dof.dof];
      dof.lower = std::min(dof.lower, dof.reference);
      dof.upper = std::max(dof.upper, dof.reference);
    }
  }
  count_limits_from(skeleton, posture, result);
  return result;
}

}  // namespace palmar::hand
