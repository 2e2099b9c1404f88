// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/joints/measured_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "hands/capture/joints/bone_errors.h"
#include "hands/capture/joints/joint_measures.h"
#include "hands/capture/joints/posture_angles.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/mirror.h"

namespace palmar::capture {
namespace {

constexpr std::array<hand::Finger, 4> kFourFingers = {hand::Finger::kIndex, hand::Finger::kMiddle,
                                                      hand::Finger::kRing, hand::Finger::kLittle};

hand::JointDof& dof_of(hand::Skeleton& skeleton, hand::Dof d) {
  for (hand::Joint& joint : skeleton.joints) {
    for (hand::JointDof& dof : joint.dofs) {
      if (dof.dof == d) return dof;
    }
  }
  throw Error("skeleton: degree of freedom \"" + std::string(name_of(d)) + "\" is missing");
}

bool is_hinge_or_mcp(hand::Dof d) { return d >= hand::Dof::kThumbMpFlexion; }
bool is_abduction(hand::Dof d) { return name_of(d).ends_with("abduction"); }
bool is_of_thumb(hand::Dof d) { return d < hand::Dof::kIndexMcpFlexion; }

void add_wrist(const hand::Hand& model, double scale, hand::Skeleton& skeleton) {
  hand::Joint wrist = model.skeleton.joint(hand::JointId::kWrist);
  const Vec3 origin = wrist.centre;
  wrist.centre = Vec3::Zero();
  for (hand::JointDof& dof : wrist.dofs) dof.centre = scale * (dof.centre - origin);
  skeleton.joints[index_of(hand::JointId::kWrist)] = std::move(wrist);
}

/// The most distal skin of each finger; without skin 3.8 mm of soft tissue beyond the last
/// bone, 5.7 mm at the thumb (Buryanov & Kotiuk 2010, Table I).
void add_fingertips(const ReferenceHand& hand, bool has_skin, hand::Skeleton& skeleton) {
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const RayNodes& ray = hand.ray[f];
    const double tissue = has_skin && ray.is_seen.back() ? 0.0 : f == 0 ? 5.7 : 3.8;
    skeleton.fingertips[f] = ray.node.back() + tissue * ray.direction(ray.node.size() - 2);
  }
}

/// The same joints free to turn as far as any joint may: to see how far the limit postures went.
hand::Skeleton without_limits(const hand::Skeleton& skeleton) {
  hand::Skeleton free = skeleton;
  for (hand::Joint& joint : free.joints) {
    for (hand::JointDof& dof : joint.dofs) {
      if (!is_hinge_or_mcp(dof.dof)) continue;
      const double reach = (is_abduction(dof.dof) ? 0.4 : 0.8) * std::numbers::pi;
      dof.lower = dof.reference - reach;
      dof.upper = dof.reference + reach;
    }
  }
  return free;
}

/// Ranges of the fingers and of the thumb's MP and IP joint from the limit postures: the scanned
/// limit is the limit, or what another posture goes beyond it (a hand bends farther round a bar
/// than by itself); the other end is the model's, widened to what was seen.
void set_ranges(const hand::Skeleton& free, const ReferenceHand& hand,
                const MotionsByPosture& motions, JointMeasures& measures) {
  std::map<hand::ScanPosture, hand::Posture> seen;
  for (const auto& [posture, moved] : motions) seen[posture] = fit_angles(free, hand, moved);
  for (int k = 0; k < hand::kDofCount; ++k) {
    const auto d = static_cast<hand::Dof>(k);
    if (!is_hinge_or_mcp(d)) continue;
    hand::JointDof& dof = dof_of(measures.skeleton, d);
    double lowest = dof.reference, highest = dof.reference;
    for (const auto& [posture, angles] : seen) {
      lowest = std::min(lowest, angles[d]);
      highest = std::max(highest, angles[d]);
    }
    dof.lower = std::min(dof.lower, lowest);
    dof.upper = std::max(dof.upper, highest);
    if (!measures.measured(d)) continue;
    const auto limit_at = [&](hand::ScanPosture posture) -> std::optional<double> {
      const auto found = seen.find(posture);
      if (found == seen.end()) return {};
      return found->second[d];
    };
    constexpr double kLeastLimit = 0.05;  // rad from the reference posture; less is no limit
    std::string scanned;
    if (is_abduction(d)) {
      const std::optional<double> spread = limit_at(hand::ScanPosture::kFingerAbduction);
      if (spread && *spread - dof.reference > kLeastLimit) {
        dof.upper = highest;
        scanned = "upper";
      } else if (spread && dof.reference - *spread > kLeastLimit) {
        dof.lower = lowest;
        scanned = "lower";
      }
    } else {
      const hand::ScanPosture bent =
          is_of_thumb(d) ? hand::ScanPosture::kThumbFlexion : hand::ScanPosture::kFingerFlexion;
      const std::optional<double> flexed = limit_at(bent);
      if (flexed && *flexed - dof.reference > kLeastLimit) {
        dof.upper = highest;
        scanned = "upper";
      }
      const std::optional<double> stretched =
          is_of_thumb(d) ? limit_at(hand::ScanPosture::kThumbExtension) : std::nullopt;
      if (stretched && dof.reference - *stretched > kLeastLimit) {
        dof.lower = lowest;
        scanned = scanned.empty() ? "lower" : "both";
      }
    }
    if (scanned == "both") {
      dof.source += "; range: scanned limits";
    } else if (!scanned.empty()) {
      dof.source += "; range: " + scanned + " limit scanned, the other the model's";
    } else {
      dof.source += "; range: the model's";
    }
  }
}

/// What is lost for want of a posture.
void note_missing_postures(const MotionsByPosture& motions, std::vector<std::string>& notes) {
  const auto has = [&](hand::ScanPosture posture) { return motions.contains(posture); };
  std::vector<std::string> limits;
  for (const hand::ScanPosture posture :
       {hand::ScanPosture::kThumbFlexion, hand::ScanPosture::kThumbExtension,
        hand::ScanPosture::kThumbAbduction, hand::ScanPosture::kThumbAdduction}) {
    if (!has(posture)) limits.emplace_back(name_of(posture));
  }
  if (limits.size() == 4) {
    notes.emplace_back(
        "No limit posture of the thumb was scanned: the thumb's joints turn about the model's "
        "axes, within the model's range.");
  } else if (!limits.empty()) {
    notes.push_back("Not scanned: " + palmar::joined(limits, ", ") +
                    ". There the thumb's CMC joint turns about the axis of the limits that were, "
                    "as far as the model's does.");
  }
  if (!limits.empty() && limits.size() < 4 && !has(hand::ScanPosture::kThumbFlexion)) {
    notes.emplace_back(
        "Without thumb_flexion, flexion of the thumb's MP and IP joints ends where the model's "
        "does.");
  }
  if (!has(hand::ScanPosture::kFingerFlexion)) {
    notes.emplace_back(
        "finger_flexion was not scanned: flexion of fingers II to V turns about the model's axes, "
        "unless another posture bends them, and ends where the model's does.");
  }
  if (!has(hand::ScanPosture::kFingerAbduction)) {
    notes.emplace_back(
        "finger_abduction was not scanned: abduction of fingers II to V is the model's, unless "
        "another posture spreads them.");
  }
  if (!has(hand::ScanPosture::kGrasp)) {
    notes.emplace_back("No grasp was scanned: the joints can't be tried on one.");
  }
}

void note_bones(const ReferenceHand& hand,
                const std::map<hand::ScanPosture, std::vector<BoneMotion>>& tracked,
                std::vector<std::string>& notes) {
  std::vector<std::string> missing, chain;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    for (const std::string& name : ray_of(static_cast<hand::Finger>(f))) {
      chain.push_back(name);
      if (!hand.bones.contains(name)) missing.push_back(name);
    }
  }
  if (!missing.empty()) {
    notes.push_back("The reference scan doesn't show: " + palmar::joined(missing, ", ") +
                    ". Their joints are the model's, set on by its proportions.");
  }
  for (const auto& [posture, motions] : tracked) {
    std::vector<std::string> lost, by_image, by_surface;
    const bool has_image = std::any_of(motions.begin(), motions.end(),
                                       [](const BoneMotion& m) { return m.image.has_value(); });
    for (const std::string& name : chain) {
      if (!hand.bones.contains(name)) continue;
      const auto found = std::find_if(motions.begin(), motions.end(),
                                      [&](const BoneMotion& m) { return m.bone == name; });
      if (found == motions.end()) {
        lost.push_back(name);
        continue;
      }
      if (!found->is_cut_out) by_image.push_back(name);
      if (has_image && !found->image) by_surface.push_back(name);
      if (found->is_cut_out && !found->counterpart.empty() && found->counterpart != name) {
        notes.push_back(
            fmt::format("{}: the bone labelled {} is taken for the {}, as it is in that bone's "
                        "joint and has its shape.",
                        name_of(posture), found->counterpart, name));
      }
    }
    if (!by_image.empty()) {
      notes.push_back(fmt::format(
          "{}: without a surface, found by the image alone: {}. Tables of errors leave it out.",
          name_of(posture), palmar::joined(by_image, ", ")));
    }
    if (!by_surface.empty()) {
      notes.push_back(
          fmt::format("{}: doesn't look in the image as in the reference, aligned by its surface "
                      "instead, which is less accurate: {}.",
                      name_of(posture), palmar::joined(by_surface, ", ")));
    }
    if (!lost.empty()) {
      notes.push_back(
          fmt::format("{}: not found again: {}. The posture says nothing about their joints.",
                      name_of(posture), palmar::joined(lost, ", ")));
    }
  }
}

void note_metacarpals(const MotionsByPosture& motions, std::vector<std::string>& notes) {
  constexpr double kLeast = 0.05;  // rad
  for (const auto& [posture, moved] : motions) {
    for (const hand::Finger finger : kFourFingers) {
      const std::string name = ray_of(finger).front();
      const auto found = moved.bone.find(name);
      if (found == moved.bone.end()) continue;
      const double turn = found->second.rotation.angularDistance(Quat::Identity());
      if (turn < kLeast) continue;
      notes.push_back(
          fmt::format("{}: the {} turns by {:.0f} degrees against the palm, which the "
                      "joints don't have; the MCP joint takes it over.",
                      name_of(posture), name, turn * geometry::kDegreesPerRadian));
    }
  }
}

}  // namespace

MeasuredJoints measure_joints(const std::map<hand::ScanPosture, ScanSurfaces>& scans,
                              const std::map<hand::ScanPosture, std::vector<BoneMotion>>& tracked,
                              const hand::Hand& model) {
  const auto reference = scans.find(hand::ScanPosture::kReference);
  if (reference == scans.end()) {
    throw InputError("joints from scans: there is no scan of the reference posture");
  }
  const hand::Hand sided = model.side == reference->second.side ? model : hand::mirrored(model);
  ReferenceHand hand = place_reference(reference->second, sided);
  MotionsByPosture motions;
  JointMeasures measures;
  for (const auto& [posture, bones] : tracked) {
    if (posture == hand::ScanPosture::kReference) continue;
    try {
      motions.emplace(posture, motions_in_hand(hand, bones, posture));
    } catch (const InputError& error) {
      measures.notes.push_back(std::string(error.what()) + "; the posture isn't used.");
    }
  }
  add_wrist(sided, hand.scale, measures.skeleton);
  measure_cmc(hand, sided, motions, measures);
  measure_finger_joints(hand, sided, motions, measures);
  add_fingertips(hand, !reference->second.skin.vertices.empty(), measures.skeleton);
  set_ranges(without_limits(measures.skeleton), hand, motions, measures);

  MeasuredJoints result;
  result.postures[hand::ScanPosture::kReference] = hand::reference_posture(measures.skeleton);
  for (const auto& [posture, moved] : motions) {
    result.postures[posture] = fit_angles(measures.skeleton, hand, moved);
  }
  result.errors = bone_errors(hand, scans, tracked, motions, result.postures, measures.skeleton,
                              measures.fixed_cmc);
  note_missing_postures(motions, result.notes);
  note_bones(hand, tracked, result.notes);
  note_metacarpals(motions, result.notes);
  result.notes.insert(result.notes.end(), measures.notes.begin(), measures.notes.end());
  result.skeleton = std::move(measures.skeleton);
  result.patient_from_hand = hand.patient_from_hand;
  result.is_measured = measures.is_measured;
  result.axis_error = measures.axis_error;
  return result;
}

}  // namespace palmar::capture
