// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/template/template_skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/skin/thumb_cmc.h"
#include "palmar/hand/template/hand_frame.h"
#include "palmar/hand/template/joint_placement.h"

namespace palmar::hand {
namespace {

struct Range {
  double lower_deg, upper_deg;
  const char* source;
};

// Means of healthy adults; negative = extension beyond straight.
constexpr const char* kLatz = "range: Latz et al. 2019 (active, 31 healthy adults)";
constexpr const char* kLatzAbduction =
    "range: Latz et al. 2019 (active, 31 healthy adults), counted from the template's posture";
constexpr std::array<Range, 4> kMcpFlexion = {
    {{-25.9, 84.7, kLatz}, {-25.9, 84.8, kLatz}, {-22.8, 87.2, kLatz}, {-32.1, 84.0, kLatz}}};
// Ulnar (negative) and radial deviation from the resting direction. The little finger's ulnar
// 54.6 degrees of Latz et al. exceed what fingers spread apart reach (14.3 + 32.1 degrees between
// middle and little finger, Chatzioglou et al. 2024), which is used instead.
constexpr std::array<Range, 4> kMcpAbduction = {
    {{-22.6, 32.1, kLatzAbduction},
     {-22.1, 28.8, kLatzAbduction},
     {-32.3, 8.1, kLatzAbduction},
     {-46.4, 15.1,
      "range: radial Latz et al. 2019, ulnar Chatzioglou et al. 2024 (between spread fingers), "
      "counted from the template's posture"}}};
constexpr Range kPipFlexion = {0, 100, "range: clinical norm (Eaton, e-Hand)"};
constexpr Range kDipFlexion = {0, 80, "range: clinical norm (Eaton, e-Hand)"};
constexpr Range kThumbMpFlexion = {-8.1, 60, "range: Barakat et al. (active, 100 healthy adults)"};
constexpr Range kThumbIpFlexion = {-12, 88, "range: Barakat et al. (active, 100 healthy adults)"};
constexpr Range kWristFlexion = {-70, 75, "range: clinical norm (Eaton, e-Hand)"};
constexpr Range kWristDeviation = {-35, 20, "range: clinical norm (Eaton, e-Hand)"};
constexpr Range kWristPronation = {
    -80, 80, "range: forearm pronation and supination, clinical norm (AAOS); by convention here"};

/// Angle from `from` to `to` seen along `axis`, right-handed, rad.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  const Vec3 a = from - from.dot(axis) * axis;
  const Vec3 b = to - to.dot(axis) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

JointDof make_dof(Dof dof, const Vec3& axis, const Vec3& centre, double reference,
                  const Range& range, const std::string& axis_source) {
  JointDof result;
  result.dof = dof;
  result.axis = axis.normalized();
  result.centre = centre;
  result.reference = reference;
  result.lower = std::min(range.lower_deg * geometry::kDegree, reference);
  result.upper = std::max(range.upper_deg * geometry::kDegree, reference);
  result.source = axis_source + "; " + range.source;
  if (result.lower < range.lower_deg * geometry::kDegree ||
      result.upper > range.upper_deg * geometry::kDegree) {
    result.source += ", widened to the template's posture";
  }
  return result;
}

constexpr const char* kFrameAxis = "axis: joint frame of the template asset";

/// Flexion axis of a joint: -x of the frame of the bone distal to it, made perpendicular to that
/// bone.
Vec3 flexion_axis(const geometry::Rigid3& frame, const Vec3& bone) {
  const Vec3 axis = frame.rotation * -Vec3::UnitX();
  const Vec3 along = bone.normalized();
  return (axis - axis.dot(along) * along).normalized();
}

Joint hinge(JointId id, Dof dof, const geometry::Rigid3& frame, const Vec3& proximal,
            const Vec3& distal, const Range& range) {
  const Vec3 centre = frame.translation;
  const Vec3 axis = flexion_axis(frame, distal - centre);
  const double reference = angle_about(axis, centre - proximal, distal - centre);
  Joint joint{id, centre, {}};
  joint.dofs.push_back(make_dof(dof, axis, centre, reference, range, kFrameAxis));
  return joint;
}

void add_finger(Skeleton& skeleton, const HandAsset& asset, Finger finger) {
  const auto frame = [&](const char* bone) { return frame_named(asset, frame_name(finger, bone)); };
  const Vec3 base = frame("metacarpal").translation;
  const geometry::Rigid3 mcp = frame("phalanx-proximal"), pip = frame("phalanx-intermediate"),
                         dip = frame("phalanx-distal"), tip = frame("tip");
  const int f = static_cast<int>(finger);
  const auto range_index = f - 1;
  const int first_joint = static_cast<int>(JointId::kIndexMcp) + 3 * (f - 1);
  const int first_dof = static_cast<int>(Dof::kIndexMcpFlexion) + 4 * (f - 1);

  const Vec3 phalanx = (pip.translation - mcp.translation).normalized();
  const Vec3 flexion = flexion_axis(mcp, phalanx);
  // Abduction towards the thumb side: right-handed about -(flexion x phalanx), i.e. dorsally.
  const Vec3 abduction = -flexion.cross(phalanx);
  const Vec3 metacarpal = mcp.translation - base;
  const double flexion_reference = angle_about(flexion, metacarpal, phalanx);
  const double abduction_reference = angle_about(abduction, metacarpal, phalanx);
  Range abduction_range = kMcpAbduction[range_index];
  abduction_range.lower_deg += abduction_reference / geometry::kDegree;
  abduction_range.upper_deg += abduction_reference / geometry::kDegree;

  Joint joint{static_cast<JointId>(first_joint), mcp.translation, {}};
  joint.dofs.push_back(make_dof(static_cast<Dof>(first_dof + 1), abduction, mcp.translation,
                                abduction_reference, abduction_range, kFrameAxis));
  joint.dofs.push_back(make_dof(static_cast<Dof>(first_dof), flexion, mcp.translation,
                                flexion_reference, kMcpFlexion[range_index], kFrameAxis));
  skeleton.joints[first_joint] = joint;
  skeleton.joints[first_joint + 1] =
      hinge(static_cast<JointId>(first_joint + 1), static_cast<Dof>(first_dof + 2), pip,
            mcp.translation, dip.translation, kPipFlexion);
  skeleton.joints[first_joint + 2] =
      hinge(static_cast<JointId>(first_joint + 2), static_cast<Dof>(first_dof + 3), dip,
            pip.translation, tip.translation, kDipFlexion);
}

void add_thumb(Skeleton& skeleton, const HandAsset& asset) {
  const auto frame = [&](const char* bone) {
    return frame_named(asset, frame_name(Finger::kThumb, bone));
  };
  const Vec3 cmc = frame("metacarpal").translation;
  const geometry::Rigid3 mp = frame("phalanx-proximal"), ip = frame("phalanx-distal");
  const Vec3 tip = frame("tip").translation;
  Joint joint = make_cmc_joint(cmc, mp.translation);
  skeleton.thumb_cmc = make_cmc_limits(joint);
  skeleton.joints[index_of(JointId::kThumbCmc)] = joint;
  skeleton.joints[index_of(JointId::kThumbMp)] =
      hinge(JointId::kThumbMp, Dof::kThumbMpFlexion, mp, cmc, ip.translation, kThumbMpFlexion);
  skeleton.joints[index_of(JointId::kThumbIp)] =
      hinge(JointId::kThumbIp, Dof::kThumbIpFlexion, ip, mp.translation, tip, kThumbIpFlexion);
}

void add_wrist(Skeleton& skeleton) {
  const std::string axis = "axis: of the hand frame";
  Joint wrist{JointId::kWrist, Vec3::Zero(), {}};
  // Deviation moves with flexion; the forearm's own turn comes last.
  wrist.dofs = {
      make_dof(Dof::kWristDeviation, -Vec3::UnitZ(), Vec3::Zero(), 0, kWristDeviation, axis),
      make_dof(Dof::kWristFlexion, Vec3::UnitX(), Vec3::Zero(), 0, kWristFlexion, axis),
      make_dof(Dof::kWristPronation, -Vec3::UnitY(), Vec3::Zero(), 0, kWristPronation, axis)};
  skeleton.joints[index_of(JointId::kWrist)] = wrist;
}

}  // namespace

Skeleton build_skeleton(const HandAsset& asset_in_hand) {
  const HandAsset asset = with_published_links(asset_in_hand);
  Skeleton skeleton;
  add_wrist(skeleton);
  add_thumb(skeleton, asset);
  for (const Finger finger : {Finger::kIndex, Finger::kMiddle, Finger::kRing, Finger::kLittle}) {
    add_finger(skeleton, asset, finger);
  }
  for (int f = 0; f < kFingerCount; ++f) {
    skeleton.fingertips[f] = fingertip(asset, static_cast<Finger>(f));
  }
  return skeleton;
}

}  // namespace palmar::hand
