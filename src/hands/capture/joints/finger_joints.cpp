// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "hands/capture/axis_fit.h"
#include "hands/capture/joints/joint_measures.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "hands/capture/two_axis_fit.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

// A flexion axis more than this off the model's is a mistake of the registration, not anatomy.
constexpr double kLargestTilt = 50.0 * geometry::kDegree;

// Axes of people's finger joints differ by 5 to 8 degrees: the model's is as good as one with a
// larger error than that.
constexpr double kNoBetter = 8.0 * geometry::kDegree;
constexpr double kDoubtful = 4.0 * geometry::kDegree;

std::string in_words(std::string_view name) {
  std::string words(name);
  for (char& c : words) c = c == '_' ? ' ' : c;
  return words;
}

/// Motions of the limit postures that turn enough to determine an axis.
struct Turns {
  std::vector<geometry::Rigid3> motion;
  std::vector<hand::ScanPosture> posture;
};

Turns turns_of(const MotionsByPosture& motions, const std::string& proximal,
               const std::string& distal) {
  Turns turns;
  for (const auto& [posture, found] : motions) {
    // What the joints are checked with isn't what they are made from.
    if (posture == hand::ScanPosture::kReference || posture == hand::ScanPosture::kGrasp) continue;
    const std::optional<geometry::Rigid3> motion = motion_between(found, proximal, distal);
    if (!motion || fit_axis(*motion, Vec3::Zero()).angle < kLeastTurn) continue;
    turns.motion.push_back(*motion);
    turns.posture.push_back(posture);
  }
  return turns;
}

std::string source_of(const Turns& turns) {
  std::string text = "axis: measured between scans (reference";
  for (const hand::ScanPosture posture : turns.posture)
    text += ", " + std::string(name_of(posture));
  return text + ")";
}

/// Model's degree of freedom with the axis as the scan's bones lie.
hand::JointDof moved_dof(const ReferenceHand& hand, const hand::Hand& model, hand::Finger finger,
                         std::size_t link, hand::Dof dof) {
  hand::JointDof result = model.skeleton.dof(dof);
  result.axis = hand.from_model(finger, link, result.axis);
  result.centre = hand.nodes(finger).node[link];
  result.source = "axis: the model's, moved onto the bones (" + result.source + ")";
  return result;
}

/// Columns: a unit direction, the part of another one perpendicular to it, and their cross product.
Eigen::Matrix3d frame_of(const Vec3& along, const Vec3& other) {
  const Vec3 across = (other - other.dot(along) * along).normalized();
  Eigen::Matrix3d frame;
  frame << along, across, along.cross(across);
  return frame;
}

/// The model's abduction axis with the proximal phalanx and its flexion axis as they were found.
Vec3 carried_axis(const ReferenceHand& hand, const hand::Hand& model, hand::Finger finger,
                  hand::Dof flexion, const Vec3& flexion_axis, hand::Dof abduction) {
  const Vec3 drawn = hand.model_ray[index_of(finger)].direction(1);
  const Eigen::Matrix3d from = frame_of(drawn, model.skeleton.dof(flexion).axis);
  const Eigen::Matrix3d to = frame_of(hand.nodes(finger).direction(1), flexion_axis);
  return to * from.transpose() * model.skeleton.dof(abduction).axis;
}

/// Whether the axis is better than the model's. Notes what is doubtful, or not used.
bool is_better(hand::Dof dof, double error, JointMeasures& measures) {
  if (error <= kDoubtful) return true;
  const bool is_used = error <= kNoBetter;
  measures.notes.push_back(fmt::format(
      "The motions show the axis of {} with a standard error of {:.0f} degrees only{}",
      in_words(name_of(dof)), error / geometry::kDegree,
      is_used ? ": it is doubtful. A posture that turns this joint further would show it."
              : ", which is no better than the model's: that is used."));
  return is_used;
}

void measure_hinge(ReferenceHand& hand, const hand::Hand& model, hand::Finger finger,
                   std::size_t link, hand::JointId id, hand::Dof dof,
                   const MotionsByPosture& motions, JointMeasures& measures) {
  const std::vector<std::string> ray = ray_of(finger);
  Vec3& node = hand.ray[index_of(finger)].node[link];
  hand::JointDof result = moved_dof(hand, model, finger, link, dof);
  const auto bone = hand.bones.find(ray[link]);
  const Turns turns = turns_of(motions, ray[link - 1], ray[link]);
  if (bone != hand.bones.end() && !turns.motion.empty()) {
    const HingeFit fit = fit_hinge(turns.motion, bone->second.points, node);
    const double sense = fit.axis.dot(result.axis) < 0.0 ? -1.0 : 1.0;
    const double tilt = std::acos(std::min(1.0, std::abs(fit.axis.dot(result.axis))));
    if (tilt < kLargestTilt && is_better(dof, fit.axis_error, measures)) {
      result.axis = sense * fit.axis;
      result.centre = fit.point;
      result.source = source_of(turns);
      node = fit.point;
      measures.set_measured(dof, fit.axis_error);
    } else if (tilt >= kLargestTilt) {
      measures.notes.push_back(
          fmt::format("The motion of the {} turns about an axis {:.0f} degrees off the one that a "
                      "{} can have; it isn't used.",
                      in_words(ray[link]), tilt / geometry::kDegree, in_words(name_of(id))));
    }
  }
  measures.skeleton.joints[index_of(id)] = {id, result.centre, {result}};
}

void measure_mcp(ReferenceHand& hand, const hand::Hand& model, hand::Finger finger,
                 hand::JointId id, hand::Dof flexion, hand::Dof abduction,
                 const MotionsByPosture& motions, JointMeasures& measures) {
  const std::vector<std::string> ray = ray_of(finger);
  Vec3& node = hand.ray[index_of(finger)].node[1];
  hand::JointDof bends = moved_dof(hand, model, finger, 1, flexion);
  hand::JointDof spreads = moved_dof(hand, model, finger, 1, abduction);
  const auto bone = hand.bones.find(ray[1]);
  const Turns turns = turns_of(motions, "", ray[1]);
  if (bone != hand.bones.end() && !turns.motion.empty()) {
    std::vector<MainAxis> main;
    for (const hand::ScanPosture posture : turns.posture) {
      main.push_back(posture == hand::ScanPosture::kFingerFlexion     ? MainAxis::kFirst
                     : posture == hand::ScanPosture::kFingerAbduction ? MainAxis::kSecond
                                                                      : MainAxis::kEither);
    }
    TwoAxisPrior prior;
    prior.near = node;
    prior.first = bends.axis;
    prior.second = spreads.axis;
    prior.slide_sd = 0.4;  // collateral ligaments hold the phalanx
    const TwoAxisFit fit = fit_two_axes(turns.motion, main, bone->second.points, prior);
    const bool has_first = fit.is_first_observed && is_better(flexion, fit.first_error, measures);
    const bool has_second =
        fit.is_second_observed && is_better(abduction, fit.second_error, measures);
    if (has_first) {
      bends.axis = fit.first_axis;
      bends.centre = fit.first_point;
      bends.source = source_of(turns);
      node = fit.first_point;
      measures.set_measured(flexion, fit.first_error);
    }
    if (has_second) {
      spreads.axis = fit.second_axis;
      spreads.centre = fit.second_point;
      spreads.source = source_of(turns);
      if (!has_first) node = fit.second_point;
      measures.set_measured(abduction, fit.second_error);
    } else if (has_first) {
      // As it lies in the model to flexion axis and phalanx.
      spreads.axis = carried_axis(hand, model, finger, flexion, bends.axis, abduction);
      spreads.centre = node;
    }
  }
  measures.skeleton.joints[index_of(id)] = {id, node, {spreads, bends}};
}

/// Angles of the reference posture, from the directions of the bones. The model's own angle shows
/// where zero is: measured on the model's bones, the same way gives its reference posture.
void set_reference_angles(const ReferenceHand& hand, const hand::Hand& model, hand::Finger finger,
                          hand::JointId id, std::size_t link, JointMeasures& measures) {
  const RayNodes& ray = hand.nodes(finger);
  const RayNodes& drawn = hand.model_ray[index_of(finger)];
  for (hand::JointDof& dof : measures.skeleton.joints[index_of(id)].dofs) {
    const hand::JointDof& of_model = model.skeleton.dof(dof.dof);
    const double zero = of_model.reference - angle_about(of_model.axis, drawn.direction(link - 1),
                                                         drawn.direction(link));
    dof.reference = zero + angle_about(dof.axis, ray.direction(link - 1), ray.direction(link));
    if (name_of(dof.dof).ends_with("abduction")) {
      // The model's range counts from its own posture.
      dof.lower += dof.reference - of_model.reference;
      dof.upper += dof.reference - of_model.reference;
    }
    dof.lower = std::min(dof.lower, dof.reference);
    dof.upper = std::max(dof.upper, dof.reference);
  }
}

}  // namespace

std::optional<geometry::Rigid3> motion_between(const PostureMotions& motions,
                                               const std::string& proximal,
                                               const std::string& distal) {
  const auto moved = motions.bone.find(distal);
  if (moved == motions.bone.end()) return {};
  if (proximal.empty()) return moved->second;
  const auto carrier = motions.bone.find(proximal);
  if (carrier == motions.bone.end()) return {};
  return carrier->second.inverse() * moved->second;
}

double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  const Vec3 a = from - from.dot(axis) * axis;
  const Vec3 b = to - to.dot(axis) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

void measure_finger_joints(ReferenceHand& hand, const hand::Hand& model,
                           const MotionsByPosture& motions, JointMeasures& measures) {
  measure_hinge(hand, model, hand::Finger::kThumb, 1, hand::JointId::kThumbMp,
                hand::Dof::kThumbMpFlexion, motions, measures);
  measure_hinge(hand, model, hand::Finger::kThumb, 2, hand::JointId::kThumbIp,
                hand::Dof::kThumbIpFlexion, motions, measures);
  set_reference_angles(hand, model, hand::Finger::kThumb, hand::JointId::kThumbMp, 1, measures);
  set_reference_angles(hand, model, hand::Finger::kThumb, hand::JointId::kThumbIp, 2, measures);
  for (const hand::Finger finger :
       {hand::Finger::kIndex, hand::Finger::kMiddle, hand::Finger::kRing, hand::Finger::kLittle}) {
    const int f = static_cast<int>(finger) - 1;
    const int joint = static_cast<int>(hand::JointId::kIndexMcp) + 3 * f;
    const int dof = static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * f;
    measure_mcp(hand, model, finger, static_cast<hand::JointId>(joint), static_cast<hand::Dof>(dof),
                static_cast<hand::Dof>(dof + 1), motions, measures);
    for (int k = 1; k < 3; ++k) {
      measure_hinge(hand, model, finger, k + 1, static_cast<hand::JointId>(joint + k),
                    static_cast<hand::Dof>(dof + 1 + k), motions, measures);
    }
    for (int k = 0; k < 3; ++k) {
      set_reference_angles(hand, model, finger, static_cast<hand::JointId>(joint + k), k + 1,
                           measures);
    }
  }
}

}  // namespace palmar::capture
