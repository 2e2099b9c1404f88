// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/subject_person.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hands/capture/skin_registration.h"
#include "hands/phantom/person/person_outline.h"
#include "hands/phantom/person/person_random.h"
#include "hands/phantom/person/person_size.h"
#include "hands/phantom/person/skin_cover.h"
#include "hands/phantom/person/soft_tissue.h"
#include "hands/phantom/person/subject_bones.h"
#include "hands/phantom/person/subject_creases.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/posture/skeleton_in_posture.h"
#include "palmar/hand/skin/skinning.h"

namespace palmar::phantom {
namespace {

enum Stream : std::uint64_t { kJoints = 3, kPostures };

// Angles of the reference scan: a hand placed down relaxed.
hand::Posture relaxed(const hand::Skeleton& skeleton, RandomStream& random) {
  hand::Posture posture = hand::reference_posture(skeleton);
  constexpr std::array<std::array<double, 3>, 4> kFlexion{
      {{16, 22, 9}, {18, 24, 9}, {20, 24, 9}, {20, 22, 9}}};  // deg, MCP, PIP, DIP
  for (int f = 0; f < 4; ++f) {
    const int first = static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * f;
    posture[static_cast<hand::Dof>(first)] =
        geometry::kDegree * (kFlexion[f][0] + spread(random, 2.0));
    posture[static_cast<hand::Dof>(first + 2)] =
        geometry::kDegree * (kFlexion[f][1] + spread(random, 2.0));
    posture[static_cast<hand::Dof>(first + 3)] =
        geometry::kDegree * (kFlexion[f][2] + spread(random, 1.5));
  }
  posture[hand::Dof::kThumbMpFlexion] = geometry::kDegree * (8.0 + spread(random, 2.0));
  posture[hand::Dof::kThumbIpFlexion] = geometry::kDegree * (10.0 + spread(random, 2.0));
  posture[hand::Dof::kThumbCmcAbduction] += geometry::kDegree * (2.0 + spread(random, 1.5));
  return posture;
}

Vec3 tilted(const Vec3& axis, RandomStream& random, double deviation) {
  return (axis + spread_vector(random, deviation)).normalized();
}

// Joints that don't turn as Hand's do, at places and about axes a little off those of the base.
void make_joints(SubjectPerson& person, std::uint64_t seed, const PersonDispersion& dispersion) {
  RandomStream random(seed, kJoints);
  const geometry::MeshDistance skin(person.skin);
  hand::Skeleton& skeleton = person.skeleton;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
    const int count = f == 0 ? 2 : 3;
    std::array<Vec3, 4> node;
    for (int k = 0; k < count; ++k) node[k] = skeleton.joint(hand::joint_of(*segments[k])).centre;
    node[count] = skeleton.fingertips[f];
    const hand::Joint& second = skeleton.joint(hand::joint_of(*segments[1]));
    const Vec3 finger = (node[2] - node[0]).normalized();
    person.finger_width[f] = finger_breadth(person.skin, node[1], second.dofs.back().axis, finger);
    // Joints of bones lie up to 1 mm dorsal of those of the base, or elsewhere by half a
    // millimetre, but so deep that there's room for the bones between them and the skin.
    const double least = 0.25 * person.finger_width[f] + kLeastSkinCover;
    for (int k = 0; k < count; ++k) {
      const hand::Joint& joint = skeleton.joint(hand::joint_of(*segments[k]));
      const Vec3 along = (node[k + 1] - node[k]).normalized();
      const Vec3 palmar = joint.dofs.back().axis.cross(along);
      const double dorsal = 0.5 + spread(random, 0.5 * dispersion.centre);
      double distal = spread(random, dispersion.centre);
      // The last bone is no stub: 15 to 20 mm in people, and the pulp.
      constexpr double kLeastEnd = 15.5;  // mm
      if (dispersion.is_free && k + 1 == count) {
        distal = std::min(distal, (node[count] - node[k]).norm() - kLeastEnd);
      }
      node[k] += distal * along - dorsal * palmar;
      if (k > 0) node[k] = sunk(skin, node[k], palmar, least, 3.0);
    }
    for (int k = 0; k < count; ++k) {
      const hand::Segment segment = *segments[k];
      hand::Joint& model = skeleton.joints[index_of(hand::joint_of(segment))];
      RollingJoint joint;
      joint.flexion = model.dofs.back().dof;
      joint.centre = node[k];
      joint.along = (node[k + 1] - node[k]).normalized();
      const Vec3 axis = tilted(model.dofs.back().axis, random, dispersion.axis);
      joint.axis = (axis - axis.dot(joint.along) * joint.along).normalized();
      joint.axis = (joint.axis + spread(random, dispersion.slant) * joint.along).normalized();
      joint.radius = (k == 0 ? 0.38 : 0.25) * person.finger_width[f];
      joint.ellipse = 0.09 + spread(random, 0.02);
      joint.creep = 0.3 + spread(random, 0.08);
      joint.twist = spread(random, 0.012);
      joint.reference = person.reference[joint.flexion];
      model.centre = joint.centre;
      if (model.dofs.size() == 2) {
        joint.abduction = model.dofs.front().dof;
        const Vec3 square = -joint.axis.cross(joint.along);
        joint.abduction_axis = tilted(square, random, 0.05);
        joint.abduction_point = joint.centre + (0.8 + spread(random, 0.3)) * joint.along;
        joint.abduction_reference = person.reference[*joint.abduction];
        model.dofs.front().axis = joint.abduction_axis;
        model.dofs.front().centre = joint.abduction_point;
      }
      model.dofs.back().axis = joint.axis;
      model.dofs.back().centre = joint.centre;
      person.joints.phalanx[index_of(segment)] = joint;
    }
  }
  // Saddle joint: axes of Mirakhorlo et al. 2016, table 3 (as in hand/skin/thumb_cmc.h), tilted; 4
  // to 6 mm apart (Chang & Pollard 2008: 4.6 mm).
  hand::Joint& model = skeleton.joints[index_of(hand::JointId::kThumbCmc)];
  SaddleJoint& cmc = person.joints.cmc;
  cmc.centre = model.centre + spread_vector(random, 0.6);
  cmc.along = (person.joints.phalanx[index_of(hand::Segment::kThumbProximal)].centre - cmc.centre)
                  .normalized();
  cmc.flexion_axis = tilted(model.dofs.at(1).axis, random, 0.06);
  cmc.abduction_axis = tilted(model.dofs.at(0).axis, random, 0.06);
  const Vec3 apart = cmc.flexion_axis.cross(cmc.abduction_axis).normalized();
  const double gap = std::clamp(5.0 + spread(random, 0.6), 4.0, 6.0);
  cmc.abduction_point = cmc.centre + (apart.dot(cmc.along) < 0.0 ? -gap : gap) * apart;
  cmc.by_flexion = 0.20 + spread(random, 0.04);
  cmc.by_abduction = -0.12 + spread(random, 0.03);
  cmc.by_both = 0.25 + spread(random, 0.08);
  // About 1.2 mm at the limits: the joint's contact moves by 1 to 4 mm (PMC3940763), single axes
  // missed the metacarpal by up to 0.87 mm more than free motions (Xie 2014, section 2.3).
  cmc.glide = 3.0;
  cmc.flexion_reference = person.reference[hand::Dof::kThumbCmcFlexion];
  cmc.abduction_reference = person.reference[hand::Dof::kThumbCmcAbduction];
  model.centre = cmc.centre;
  model.dofs.at(1).axis = cmc.flexion_axis;
  model.dofs.at(1).centre = cmc.centre;
  model.dofs.at(0).axis = cmc.abduction_axis;
  model.dofs.at(0).centre = cmc.abduction_point;
}

// Middles and ends of a finger's phalanges, where they are in a posture.
std::vector<Vec3> chain(const SubjectPerson& person, int f, const hand::Posture& posture) {
  const auto motion = body_motions(person.joints, posture);
  const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
  const int count = f == 0 ? 2 : 3;
  std::vector<Vec3> point;
  for (int k = 0; k < count; ++k) {
    const std::size_t body = index_of(*segments[k]);
    const RollingJoint& joint = person.joints.phalanx[body];
    const Vec3 end = k + 1 < count ? person.joints.phalanx[body + 1].centre
                                   : Vec3(person.skeleton.fingertips[f] - 6.0 * joint.along);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      point.push_back(motion[body] * (joint.centre + share * (end - joint.centre)));
    }
  }
  return point;
}

// Least distance of two fingers' axes over the mean of their widths.
double nearness(const SubjectPerson& person, int f, int g, const hand::Posture& posture) {
  double nearest = std::numeric_limits<double>::max();
  const std::vector<Vec3> mine = chain(person, f, posture), other = chain(person, g, posture);
  for (const Vec3& p : mine) {
    for (const Vec3& q : other) nearest = std::min(nearest, (p - q).norm());
  }
  return nearest / (0.5 * (person.finger_width[f] + person.finger_width[g]));
}

// Whether the thumb touches no finger and isn't pressed hard on the bar.
bool is_clear(const SubjectPerson& person, const hand::Posture& posture) {
  for (const Vec3& p : chain(person, 0, posture)) {
    if (person.bar.distance(p) < person.bar.radius + 0.45 * person.finger_width[0]) return false;
  }
  for (int f = 1; f < hand::kFingerCount; ++f) {
    if (nearness(person, 0, f, posture) < 1.0) return false;
  }
  return true;
}

// Bent fingers push each other aside until they lie side by side.
void make_room(const SubjectPerson& person, hand::Posture& posture) {
  const auto abduction = [](int f) {
    return static_cast<hand::Dof>(static_cast<int>(hand::Dof::kIndexMcpAbduction) + 4 * (f - 1));
  };
  for (int round = 0; round < 40; ++round) {
    bool is_free = true;
    for (int f = 1; f + 1 < hand::kFingerCount; ++f) {
      if (nearness(person, f, f + 1, posture) >= 0.94) continue;
      is_free = false;
      // The outer of the two gives way.
      (f == 1 ? posture[abduction(1)] : posture[abduction(f + 1)]) +=
          (f == 1 ? 1.0 : -1.0) * 0.6 * geometry::kDegree;
    }
    if (is_free) return;
  }
}

// A bar across the palm below the knuckles, a little into the skin.
HeldBar placed_in_palm(const SubjectPerson& person, double radius) {
  const auto mcp = [&](hand::Segment s) -> const Vec3& {
    return person.joints.phalanx[index_of(s)].centre;
  };
  const Vec3 &index = mcp(hand::Segment::kIndexProximal),
             &little = mcp(hand::Segment::kLittleProximal);
  HeldBar bar;
  bar.radius = radius;
  bar.axis = (index - little).normalized();
  bar.point = 0.5 * (index + little);
  bar.axis.z() = 0.0;
  bar.axis.normalize();
  double palm = bar.point.z();
  for (const Vec3& v : person.skin.vertices) {
    const Vec3 arm = v - bar.point;
    const double along = arm.dot(bar.axis);
    const double across = arm.y() - along * bar.axis.y();
    if (std::abs(along) < 30.0 && std::abs(across) < 8.0) palm = std::max(palm, v.z());
  }
  bar.point.z() = palm + radius - 2.0;
  return bar;
}

// Bends a finger joint by joint until each phalanx lies on the bar.
void close_on(const SubjectPerson& person, int f, hand::Posture& posture) {
  constexpr double kStep = 0.5 * geometry::kDegree;
  const auto segments = hand::segments_of(static_cast<hand::Finger>(f));
  const int count = f == 0 ? 2 : 3;
  const std::array<double, 3> most{f == 0 ? 40.0 * geometry::kDegree : 80.0 * geometry::kDegree,
                                   f == 0 ? 50.0 * geometry::kDegree : 95.0 * geometry::kDegree,
                                   55.0 * geometry::kDegree};
  for (int k = 0; k < count; ++k) {
    const std::size_t body = index_of(*segments[k]);
    const RollingJoint& joint = person.joints.phalanx[body];
    const Vec3 end =
        k + 1 < count ? person.joints.phalanx[body + 1].centre : person.skeleton.fingertips[f];
    // From the axis of the bone to its palmar skin; the last phalanx is thinner.
    const double flesh = (k + 1 < count ? 0.50 : 0.46) * person.finger_width[f] - 0.6;
    const auto is_free = [&] {
      const geometry::Rigid3 motion = body_motions(person.joints, posture)[body];
      for (const double share : {0.5, 0.7, 0.9}) {
        const Vec3 p = motion * (joint.centre + share * (end - joint.centre));
        if (person.bar.distance(p) < person.bar.radius + flesh) return false;
      }
      return true;
    };
    double& angle = posture[joint.flexion];
    while (angle < most[k] && is_free() && (f > 0 || is_clear(person, posture))) {
      angle += kStep;
    }
  }
}

void make_postures(SubjectPerson& person, std::uint64_t seed) {
  RandomStream random(seed, kPostures);
  const hand::Posture& reference = person.reference;
  const auto turned = [&](hand::Posture& p, hand::Dof dof, double degrees, double deviation) {
    p[dof] += geometry::kDegree * (degrees + spread(random, deviation));
  };
  const auto thumb = [&](double flexion, double abduction, double mp, double ip) {
    hand::Posture p = reference;
    turned(p, hand::Dof::kThumbCmcFlexion, flexion, 1.5);
    turned(p, hand::Dof::kThumbCmcAbduction, abduction, 1.5);
    turned(p, hand::Dof::kThumbMpFlexion, mp, 2.0);
    turned(p, hand::Dof::kThumbIpFlexion, ip, 2.0);
    return p;
  };
  // Fingers at rest are never where they were.
  const auto at_rest = [&](hand::Posture p) {
    for (int f = 0; f < 4; ++f) {
      constexpr std::array<double, 4> kDeviation{3.0, 1.5, 3.0, 2.0};
      const int first = static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * f;
      for (int k = 0; k < 4; ++k) {
        turned(p, static_cast<hand::Dof>(first + k), 0.0, kDeviation[k]);
      }
    }
    return p;
  };
  const auto finger = [&](hand::Posture& p, int f, const std::array<double, 4>& degrees) {
    const int first = static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * f;
    for (int k = 0; k < 4; ++k) turned(p, static_cast<hand::Dof>(first + k), degrees[k], 1.0);
  };
  auto& all = person.postures;
  all[hand::ScanPosture::kReference] = reference;
  // In the limits of flexion MP and IP bend and stretch as well, in those of abduction hardly.
  all[hand::ScanPosture::kThumbFlexion] = at_rest(thumb(22.0, 0.0, 32.0, 42.0));
  all[hand::ScanPosture::kThumbExtension] = at_rest(thumb(-22.0, 0.0, -12.0, -16.0));
  all[hand::ScanPosture::kThumbAbduction] = at_rest(thumb(0.0, 18.0, 0.0, 0.0));
  all[hand::ScanPosture::kThumbAdduction] = at_rest(thumb(0.0, -22.0, -1.0, 2.0));

  // Degrees from the reference posture: MCP flexion, abduction, PIP, DIP.
  hand::Posture fist = thumb(-14.0, 4.0, -4.0, -6.0);
  finger(fist, 0, {50, 0, 62, 38});
  finger(fist, 1, {52, 0, 64, 38});
  finger(fist, 2, {52, 0, 62, 38});
  finger(fist, 3, {50, 0, 60, 38});
  make_room(person, fist);
  all[hand::ScanPosture::kFingerFlexion] = fist;
  hand::Posture fan = thumb(-4.0, 2.0, -2.0, -2.0);
  finger(fan, 0, {0, 12, -6, -3});
  finger(fan, 1, {0, 2, -6, -3});
  finger(fan, 2, {0, -9, -6, -3});
  finger(fan, 3, {0, -17, -6, -3});
  all[hand::ScanPosture::kFingerAbduction] = fan;
  hand::Posture grasp = thumb(9.0, 15.0, 0.0, 0.0);
  person.bar = placed_in_palm(person, 18.5 + spread(random, 1.0));
  for (int f = 1; f < hand::kFingerCount; ++f) close_on(person, f, grasp);
  make_room(person, grasp);
  // The thumb gives way to the fingers, then closes.
  const double least = grasp[hand::Dof::kThumbCmcFlexion] - 30.0 * geometry::kDegree;
  while (!is_clear(person, grasp) && grasp[hand::Dof::kThumbCmcFlexion] > least) {
    grasp[hand::Dof::kThumbCmcFlexion] -= geometry::kDegree;
  }
  close_on(person, 0, grasp);
  all[hand::ScanPosture::kGrasp] = grasp;
}

void find_fingertips(SubjectPerson& person, const std::vector<hand::Segment>& segment) {
  for (int f = 0; f < hand::kFingerCount; ++f) {
    person.skeleton.fingertips[f] = capture::fingertip_of(
        person.skin.vertices, segment, person.skeleton, static_cast<hand::Finger>(f));
  }
}

// Outline and reference posture of a free person: the hand in its own posture, with the joints of
// its skeleton, is relaxed as a person's skin follows its bones.
void relax_own_tissue(SubjectPerson& person, const hand::Hand& hand, std::uint64_t seed,
                      const PersonDispersion& dispersion) {
  SubjectPerson open;
  open.reference = hand::reference_posture(hand.skeleton);
  open.skin = hand.skin;
  open.skeleton = hand.skeleton;
  shape_fingers(open.skin, hand, seed, dispersion);
  give_relief(open.skin, open.skeleton, seed, dispersion.relief);
  lengthen_forearm(open.skin, open.skeleton.joint(hand::JointId::kWrist).centre);
  find_fingertips(open, hand.segment);
  make_joints(open, seed, {.axis = 0.0, .slant = 0.0, .centre = 0.0});
  open.postures[hand::ScanPosture::kReference] = person.reference;
  const std::vector<SubjectBone> bones = make_subject_bones(open, seed);
  person.skin = open.skin;
  person.skin.vertices = SoftTissue(open, bones).pose(person.reference).skin;
  person.skeleton = subject_skeleton(open, person.reference);
}

}  // namespace

SubjectPerson make_person(const hand::Hand& base, std::uint64_t seed,
                          const PersonDispersion& dispersion) {
  const hand::Hand hand = sized_hand(base, seed, dispersion);
  RandomStream random(seed, kPostures + 1);
  SubjectPerson person;
  person.reference = relaxed(hand.skeleton, random);
  if (dispersion.is_free) {
    relax_own_tissue(person, hand, seed, dispersion);
  } else {
    person.skin = hand.skin;
    person.skin.vertices = hand::pose_skin(hand, person.reference);
    person.skeleton = hand::skeleton_in_posture(hand.skeleton, person.reference);
    give_relief(person.skin, person.skeleton, seed, dispersion.relief);
    lengthen_forearm(person.skin, person.skeleton.joint(hand::JointId::kWrist).centre);
  }
  find_fingertips(person, hand.segment);
  make_joints(person, seed, dispersion);
  make_postures(person, seed);
  return person;
}

}  // namespace palmar::phantom
