// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/subject_creases.h"

#include "palmar/core/enum_index.h"
#include "hands/phantom/person/person_random.h"

namespace palmar {
namespace {

constexpr std::uint64_t kCreaseStream = 60, kSlopeStream = 63;

void slope(CreasePlane& plane, const Vec3& palmar, double angle) {
  plane.normal = Eigen::AngleAxisd(angle, palmar) * plane.normal;
}

}  // namespace

HandCreases subject_creases(const TriangleMesh& skin, const Skeleton& skeleton, std::uint64_t seed,
                            const PersonDispersion& dispersion) {
  HandCreases creases(skin, skeleton);
  RandomStream random(seed, kCreaseStream), slopes(seed, kSlopeStream);
  for (int k = 1; k < kSegmentCount; ++k) {
    const auto segment = static_cast<Segment>(k);
    CreasePlane plane = creases.proximal_crease(segment);
    plane.point += spread(random, dispersion.crease) * plane.normal;
    const Finger finger = *finger_of(segment);
    const int first = static_cast<int>(*segments_of(finger)[0]);
    const int node = (finger == Finger::kThumb ? 2 : 1) + k - first;
    slope(plane, creases.palmar_direction(finger, node), spread(slopes, dispersion.crease_slope));
    creases.set_proximal_crease(segment, plane);
  }
  CreasePlane wrist = creases.wrist();
  wrist.point += spread(random, 1.5 * dispersion.crease) * wrist.normal;
  slope(wrist, Vec3::UnitZ(), spread(slopes, 0.5 * dispersion.crease_slope));
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
