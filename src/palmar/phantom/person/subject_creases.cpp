// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/phantom/person/subject_creases.h"

#include <algorithm>

#include "palmar/core/enum_index.h"
#include "palmar/core/random.h"

namespace palmar {
namespace {

constexpr std::uint64_t kCreaseStream = 60;

double crease_offset(RandomStream& random, double deviation) {
  return deviation * std::clamp(random.normal(), -2.5, 2.5);
}

}  // namespace

HandCreases subject_creases(const TriangleMesh& skin, const Skeleton& skeleton,
                            std::uint64_t seed) {
  HandCreases creases(skin, skeleton);
  RandomStream random(seed, kCreaseStream);
  for (int k = 1; k < kSegmentCount; ++k) {
    const auto segment = static_cast<Segment>(k);
    CreasePlane plane = creases.proximal_crease(segment);
    plane.point += crease_offset(random, 0.8) * plane.normal;
    creases.set_proximal_crease(segment, plane);
  }
  CreasePlane wrist = creases.wrist();
  wrist.point += crease_offset(random, 1.2) * wrist.normal;
  creases.set_wrist(wrist);
  return creases;
}

Skeleton subject_skeleton(const SubjectPerson& person, const Posture& posture) {
  const auto motion = body_motions(person.joints, posture);
  Skeleton skeleton = person.skeleton;
  for (int f = 0; f < kFingerCount; ++f) {
    for (const auto& segment : segments_of(static_cast<Finger>(f))) {
      if (!segment) continue;
      const int body = static_cast<int>(*segment);
      const Rigid3& after = motion[body];
      const Rigid3& before = motion[*parent_of(body)];
      Joint& joint = skeleton.joints[index_of(joint_of(*segment))];
      joint.centre = before * joint.centre;
      for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        // Of two axes the first is fixed to the distal part.
        const Rigid3& by = k + 1 < joint.dofs.size() ? after : before;
        joint.dofs[k].axis = by.rotation * joint.dofs[k].axis;
        joint.dofs[k].centre = by * joint.dofs[k].centre;
      }
    }
    const auto chain = segments_of(static_cast<Finger>(f));
    const Segment last = *chain[chain[2] ? 2 : 1];
    Vec3& tip = skeleton.fingertips[f];
    tip = motion[index_of(last)] * tip;
  }
  for (Joint& joint : skeleton.joints) {
    for (JointDof& dof : joint.dofs) dof.reference = posture[dof.dof];
  }
  return skeleton;
}

}  // namespace palmar
