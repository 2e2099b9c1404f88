// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/scanned_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hands/capture/mri/bones/palm_placement.h"
#include "hands/capture/mri/thumb_ball_scan.h"
#include "hands/capture/skin_errors.h"
#include "hands/capture/skin_registration.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/text.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/joint_weights.h"
#include "palmar/hand/skin/regions.h"
#include "palmar/hand/tissue.h"

namespace palmar::capture {
namespace {

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const geometry::Rigid3& motion) {
  for (Vec3& v : mesh.vertices) v = motion * v;
  return mesh;
}

SkinScan skin_scan(const ScanSurfaces& scan, const geometry::Rigid3& hand_from_patient) {
  SkinScan result;
  result.skin = moved(scan.skin, hand_from_patient);
  for (const Vec3& marker : scan.markers) result.markers.push_back(hand_from_patient * marker);
  return result;
}

/// The scan's bones by the model's names and ways of moving; the model's where the scan has none.
std::vector<hand::Bone> bones_of(const ScanSurfaces& scan,
                                 const geometry::Rigid3& hand_from_patient, const PosedModel& model,
                                 const hand::Skeleton& skeleton, std::vector<std::string>& notes) {
  std::vector<hand::Bone> bones = model.sized.bones;
  std::vector<geometry::TriangleMesh> meshes = bones_at(model, skeleton);
  std::vector<std::string> missing;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const auto found = std::find_if(scan.bones.begin(), scan.bones.end(),
                                    [&](const auto& bone) { return bone.name == bones[b].name; });
    if (found == scan.bones.end()) {
      missing.push_back(bones[b].name);
      bones[b].mesh = std::move(meshes[b]);
    } else {
      bones[b].mesh = moved(found->mesh, hand_from_patient);
    }
  }
  if (missing.size() == bones.size()) {
    notes.emplace_back("The scan shows no bones: all are the model's, moved along.");
  } else if (!missing.empty()) {
    notes.push_back("Bones that the scan doesn't show are the model's, moved along: " +
                    palmar::joined(missing, ", ") + ".");
  }
  return bones;
}

constexpr std::array<hand::ScanPosture, 4> kThumbLimits{
    hand::ScanPosture::kThumbFlexion, hand::ScanPosture::kThumbExtension,
    hand::ScanPosture::kThumbAbduction, hand::ScanPosture::kThumbAdduction};

/// The scans of the thumb's limit postures in the hand frame.
std::array<std::optional<ThumbLimitScan>, 4> thumb_limits(
    const std::map<hand::ScanPosture, ScanSurfaces>& scans, const MeasuredJoints& joints,
    std::vector<std::string>& notes) {
  std::array<std::optional<ThumbLimitScan>, 4> limits;
  const ScanSurfaces& reference = scans.at(hand::ScanPosture::kReference);
  for (std::size_t l = 0; l < kThumbLimits.size(); ++l) {
    const auto scan = scans.find(kThumbLimits[l]);
    const auto posture = joints.postures.find(kThumbLimits[l]);
    if (scan == scans.end() || posture == joints.postures.end()) continue;
    if (const auto known = joints.patient_from_hand_in.find(kThumbLimits[l]);
        known != joints.patient_from_hand_in.end()) {
      limits[l] = ThumbLimitScan{posture->second, skin_scan(scan->second, known->second.inverse())};
      continue;
    }
    const auto moved_palm = place_palm(reference, scan->second);
    if (!moved_palm) {
      notes.push_back(
          fmt::format("The scan of {} shows too few bones of the palm to find where the hand is.",
                      name_of(kThumbLimits[l])));
      continue;
    }
    const geometry::Rigid3 hand_from_patient = (*moved_palm * joints.patient_from_hand).inverse();
    limits[l] = ThumbLimitScan{posture->second, skin_scan(scan->second, hand_from_patient)};
  }
  return limits;
}

/// Corrects the thumb ball and measures what that brings (Xie 2014, table 2-5).
void correct_thumb_ball(const std::array<std::optional<ThumbLimitScan>, 4>& limits,
                        const std::vector<Vec3>& markers, const Progress& progress,
                        ScannedHand& result) {
  hand::Hand& hand = result.hand;
  ThumbBallFit fit = fit_scanned_thumb_ball(hand, markers, limits, {}, progress);
  result.notes.insert(result.notes.end(), fit.notes.begin(), fit.notes.end());
  if (std::none_of(limits.begin(), limits.end(), [](const auto& l) { return l.has_value(); })) {
    return;
  }
  result.notes.push_back(
      fmt::format("The thumb ball is corrected by {} markers and {} points of the scanned skin.",
                  fit.markers, fit.skin_points));
  const std::vector<int> round_ball = thumb_ball_skin(hand);
  const auto errors_with = [&](hand::ThumbBallCorrection correction) {
    hand.thumb_ball = std::move(correction);
    std::array<std::optional<double>, 4> errors;
    for (std::size_t l = 0; l < limits.size(); ++l) {
      if (!limits[l]) continue;
      errors[l] = mean_skin_error(hand, limits[l]->posture, round_ball, limits[l]->skin);
    }
    return errors;
  };
  const auto without = errors_with({});
  const auto markers_alone =
      fit.by_markers ? errors_with(*fit.by_markers) : std::array<std::optional<double>, 4>{};
  const auto with = errors_with(std::move(fit.correction));
  for (std::size_t l = 0; l < limits.size(); ++l) {
    if (!without[l]) continue;
    result.skin_errors.push_back({kThumbLimits[l], *without[l], with[l], markers_alone[l]});
  }
}

}  // namespace

ScannedHand make_scanned_hand(const hand::Hand& model,
                              const std::map<hand::ScanPosture, ScanSurfaces>& scans,
                              const MeasuredJoints& joints, const Progress& progress) {
  const auto reference = scans.find(hand::ScanPosture::kReference);
  if (reference == scans.end()) {
    throw InputError("hand from scans: there is no scan of the reference posture");
  }
  const ScanSurfaces& scan = reference->second;
  const hand::Hand base = model.side == scan.side ? model : hand::mirrored(model);
  const geometry::Rigid3 hand_from_patient = joints.patient_from_hand.inverse();

  ScannedHand result;
  result.patient_from_hand = joints.patient_from_hand;
  const SkinScan skin = skin_scan(scan, hand_from_patient);
  RegisteredSkin registered =
      register_skin(base, skin, joints.skeleton, part_of(progress, 0.0, 0.5));
  result.registration_mean = registered.mean;
  result.registration_p95 = registered.percentile_95;
  constexpr double kWholeShare = 0.97;
  if (registered.partner_share < kWholeShare) {
    result.notes.push_back(
        fmt::format("{:.0f} % of the hand's skin isn't in the scan (touching fingers, spots, "
                    "holes); there it follows its surroundings.",
                    100.0 * (1.0 - registered.partner_share)));
  }

  constexpr double kLeftOver = 0.01;
  if (registered.left_over > kLeftOver) {
    result.notes.push_back(
        fmt::format("{:.0f} % of the scanned skin is more than 2 mm from the hand's: joints or "
                    "surfaces are wrong somewhere.",
                    100.0 * registered.left_over));
  }

  hand::Hand& hand = result.hand;
  hand.name = "scanned";
  hand.side = scan.side;
  hand.skeleton = joints.skeleton;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    hand.skeleton.fingertips[f] =
        fingertip_of(registered.skin, base.segment, hand.skeleton, finger);
  }
  hand::SkinPartition partition =
      hand::partition_skin({std::move(registered.skin), base.skin.triangles}, hand.skeleton);
  hand.skin = std::move(partition.skin);
  hand.segment = std::move(partition.segment);
  hand.region = std::move(partition.region);
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    hand.skeleton.fingertips[f] =
        fingertip_of(hand.skin.vertices, hand.segment, hand.skeleton, finger);
  }
  hand.weights = hand::make_joint_weights(hand.skin, hand.skeleton);
  hand.bones = bones_of(scan, hand_from_patient, registered.start, hand.skeleton, result.notes);
  hand.dimensions = hand::measure_hand(hand);
  hand.tissue = hand::default_tissue();
  correct_thumb_ball(thumb_limits(scans, joints, result.notes), skin.markers,
                     part_of(progress, 0.5, 1.0), result);
  hand.provenance =
      "skin, bones and joints from scans of a person; triangles fitted to the skin by registration "
      "of: " +
      base.provenance;
  return result;
}

}  // namespace palmar::capture
