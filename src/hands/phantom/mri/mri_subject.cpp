// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/mri_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hands/phantom/mri/subject_tissues.h"
#include "hands/phantom/person/held_bar.h"
#include "hands/phantom/person/soft_tissue.h"
#include "hands/phantom/person/subject_bones.h"
#include "hands/phantom/person/subject_person.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/mirror.h"

namespace palmar::phantom {
namespace {

constexpr std::uint64_t kPlacementStream = 40;

// From the hand frame of a right hand (or of the mirror image of a left one) to the patient's.
struct ToPatient {
  bool is_left = false;
  geometry::Rigid3 patient_from_hand;  ///< of the side it is

  Vec3 mirrored(const Vec3& v) const { return is_left ? Vec3(-v.x(), v.y(), v.z()) : v; }
  Vec3 point(const Vec3& v) const { return patient_from_hand * mirrored(v); }
  Vec3 direction(const Vec3& v) const { return patient_from_hand.rotation * mirrored(v); }
  /// Of a rotation: mirrored and turned round, so that the same angle is the same motion.
  Vec3 axis(const Vec3& v) const { return is_left ? Vec3(-direction(v)) : direction(v); }
  geometry::TriangleMesh mesh(geometry::TriangleMesh m) const {
    for (Vec3& v : m.vertices) v = point(v);
    if (is_left) {
      for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
    }
    return m;
  }
  /// A motion within the hand frame.
  geometry::Rigid3 motion(const geometry::Rigid3& m) const {
    if (!is_left) return m;
    const Quat& q = m.rotation;
    return {Quat(q.w(), q.x(), -q.y(), -q.z()), mirrored(m.translation)};
  }
};

// Prone, the arm stretched out over the head, the palm down: distal is towards the head's end of
// the scanner (+z), palmar is the patient's front (-y). People don't lie as straight as that, and
// between two scans they move.
geometry::Rigid3 placement(RandomStream& random, double degrees, double shift) {
  const auto some = [&](double deviation) {
    Vec3 v;
    for (int k = 2; k >= 0; --k) v[k] = deviation * std::clamp(random.normal(), -2.0, 2.0);
    return v;
  };
  const Vec3 turn = some(degrees), by = some(shift);
  const double angle = turn.norm() * geometry::kDegree;
  return {angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn.normalized())) : Quat::Identity(), by};
}

bool shows_markers(hand::ScanPosture posture) {
  return posture == hand::ScanPosture::kReference || posture == hand::ScanPosture::kThumbFlexion ||
         posture == hand::ScanPosture::kThumbExtension ||
         posture == hand::ScanPosture::kThumbAbduction ||
         posture == hand::ScanPosture::kThumbAdduction;
}

std::vector<MriSubject::TrueAxis> true_axes(const SubjectPerson& person, const ToPatient& to) {
  std::vector<MriSubject::TrueAxis> axes;
  const auto add = [&](int body, hand::Dof dof) {
    const InstantAxis axis = instant_axis(person.joints, person.reference, body, dof);
    axes.push_back({std::string(name_of(dof)), to.axis(axis.axis), to.point(axis.point)});
  };
  add(kThumbMetacarpalBody, hand::Dof::kThumbCmcFlexion);
  add(kThumbMetacarpalBody, hand::Dof::kThumbCmcAbduction);
  for (int body = 1; body < hand::kSegmentCount; ++body) {
    const RollingJoint& joint = person.joints.phalanx[body];
    add(body, joint.flexion);
    if (joint.abduction) add(body, *joint.abduction);
  }
  return axes;
}

}  // namespace

void MriSubjectOptions::check() const {
  if (markers < 0 || markers > 40) {
    throw UsageError(fmt::format("markers is {}; allowed are 0 to 40", markers));
  }
}

MriSubject make_mri_subject(const hand::Hand& base, const MriSubjectOptions& options) {
  options.check();
  const hand::Hand right = base.side == hand::Side::kRight ? base : hand::mirrored(base);
  const SubjectPerson person = make_person(right, options.seed, options.dispersion);
  const std::vector<SubjectBone> bones = make_subject_bones(person, options.seed);
  const SoftTissue tissue(person, bones);
  const std::vector<int> marked = marker_vertices(person, tissue, options.markers);

  MriSubject subject;
  subject.name = fmt::format("subject {}", options.seed);
  subject.side = options.side;
  subject.dimensions = hand::measure_hand(person.skin, person.skeleton);

  // Columns: where x (radial), y (distal), z (palmar) of a right hand point to.
  Eigen::Matrix3d axes;
  axes << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0;
  RandomStream random(options.seed, kPlacementStream);
  geometry::Rigid3 lying = placement(random, 1.6, 8.0);
  const Vec3 middle = 0.9 * person.skeleton.joint(hand::JointId::kMiddleMcp).centre;
  lying = lying * geometry::Rigid3{Quat(axes), Vec3::Zero()};
  lying.translation -= lying.rotation * middle;

  std::vector<std::pair<hand::ScanPosture, ToPatient>> scans;
  for (const auto& [posture, angles] : person.postures) {
    const geometry::Rigid3 shift =
        posture == hand::ScanPosture::kReference ? geometry::Rigid3{} : placement(random, 1.4, 2.5);
    scans.push_back({posture, {options.side == hand::Side::kLeft, shift * lying}});
    subject.angles[posture] = angles.angle;
    subject.postures[posture] = {};
  }
  const ToPatient& reference = scans.front().second;
  for (const SubjectBone& b : bones) {
    hand::Bone bone = b.bone;
    bone.mesh = reference.mesh(bone.mesh);
    subject.bones.push_back(std::move(bone));
  }
  subject.axes = true_axes(person, reference);

  parallel_for(static_cast<int>(scans.size()), [&](int s) {
    const auto& [name, to] = scans[s];
    const hand::Posture& posture = person.postures.at(name);
    const auto motion = body_motions(person.joints, posture);
    PosedTissue posed = tissue.pose(posture);
    if (name == hand::ScanPosture::kReference) posed.skin = person.skin.vertices;
    SubjectPosture& result = subject.postures.at(name);
    if (name == hand::ScanPosture::kGrasp) {
      flatten_on(person.bar, posed.skin);
      result.product = to.mesh(bar_mesh(person.bar));
    }
    const std::vector<Vec3>& skin = posed.skin;
    std::vector<Vec3> markers;
    if (shows_markers(name)) {
      const std::vector<Vec3> normal = geometry::vertex_normals(skin, person.skin.triangles);
      for (const int v : marked) markers.push_back(skin[v] + kMarkerRadius * normal[v]);
    }
    result.skin = to.mesh({skin, person.skin.triangles});
    for (const SubjectBone& b : bones) {
      result.bone[b.bone.name] =
          to.patient_from_hand * to.motion(motion[b.body]) * reference.patient_from_hand.inverse();
    }
    result.parts = tissue_parts({.person = &person,
                                 .bones = &bones,
                                 .tissue = &tissue,
                                 .posed = posed,
                                 .motion = motion,
                                 .markers = markers},
                                options.has_fixture);
    for (ImagedPart& part : result.parts) part.mesh = to.mesh(std::move(part.mesh));
    for (const Vec3& m : markers) result.markers.push_back(to.point(m));
  });
  return subject;
}

}  // namespace palmar::phantom
