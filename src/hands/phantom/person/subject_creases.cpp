// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/subject_creases.h"

#include "hands/phantom/person/person_random.h"
#include "palmar/core/enum_index.h"

namespace palmar::phantom {
namespace {

constexpr std::uint64_t kCreaseStream = 60, kSlopeStream = 63;

void slope(hand::CreasePlane& plane, const Vec3& palmar, double angle) {
  plane.normal = Eigen::AngleAxisd(angle, palmar) * plane.normal;
}

}  // namespace

hand::HandCreases subject_creases(const geometry::TriangleMesh& skin,
                                  const hand::Skeleton& skeleton, std::uint64_t seed,
                                  const PersonDispersion& dispersion) {
  hand::HandCreases creases(skin, skeleton);
  RandomStream random(seed, kCreaseStream), slopes(seed, kSlopeStream);
  for (int k = 1; k < hand::kSegmentCount; ++k) {
    const auto segment = static_cast<hand::Segment>(k);
    hand::CreasePlane plane = creases.proximal_crease(segment);
    plane.point += spread(random, dispersion.crease) * plane.normal;
    const hand::Finger finger = *hand::finger_of(segment);
    const int first = static_cast<int>(*hand::segments_of(finger)[0]);
    const int node = (finger == hand::Finger::kThumb ? 2 : 1) + k - first;
    slope(plane, creases.palmar_direction(finger, node), spread(slopes, dispersion.crease_slope));
    creases.set_proximal_crease(segment, plane);
  }
  hand::CreasePlane wrist = creases.wrist();
  wrist.point += spread(random, 1.5 * dispersion.crease) * wrist.normal;
  slope(wrist, Vec3::UnitZ(), spread(slopes, 0.5 * dispersion.crease_slope));
  creases.set_wrist(wrist);
  return creases;
}

hand::Skeleton subject_skeleton(const SubjectPerson& person, const hand::Posture& posture) {
  const auto motion = body_motions(person.joints, posture);
  hand::Skeleton skeleton = person.skeleton;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    for (const auto& segment : hand::segments_of(static_cast<hand::Finger>(f))) {
      if (!segment) continue;
      const int body = static_cast<int>(*segment);
      const geometry::Rigid3& after = motion[body];
      const geometry::Rigid3& before = motion[*parent_of(body)];
      hand::Joint& joint = skeleton.joints[index_of(hand::joint_of(*segment))];
      joint.centre = before * joint.centre;
      for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        // Of two axes the first is fixed to the distal part.
        const geometry::Rigid3& by = k + 1 < joint.dofs.size() ? after : before;
        joint.dofs[k].axis = by.rotation * joint.dofs[k].axis;
        joint.dofs[k].centre = by * joint.dofs[k].centre;
      }
    }
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    const hand::Segment last = *chain[chain[2] ? 2 : 1];
    Vec3& tip = skeleton.fingertips[f];
    tip = motion[index_of(last)] * tip;
  }
  for (hand::Joint& joint : skeleton.joints) {
    for (hand::JointDof& dof : joint.dofs) dof.reference = posture[dof.dof];
  }
  return skeleton;
}

}  // namespace palmar::phantom
