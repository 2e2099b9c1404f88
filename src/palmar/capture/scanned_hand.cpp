// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/scanned_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "palmar/capture/skin_registration.h"
#include "palmar/core/error.h"
#include "palmar/hand/dimensions.h"
#include "palmar/hand/joint_weights.h"
#include "palmar/hand/regions.h"
#include "palmar/hand/template_hand.h"
#include "palmar/hand/tissue.h"

namespace palmar {
namespace {

TriangleMesh moved(TriangleMesh mesh, const Rigid3& motion) {
  for (Vec3& v : mesh.vertices) v = motion * v;
  return mesh;
}

SkinScan skin_scan(const ScanSurfaces& scan, const Rigid3& hand_from_patient) {
  SkinScan result;
  result.skin = moved(scan.skin, hand_from_patient);
  for (const Vec3& marker : scan.markers) result.markers.push_back(hand_from_patient * marker);
  return result;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The scan's bones by the model's names and ways of moving; the model's where the scan has none.
std::vector<Bone> bones_of(const ScanSurfaces& scan, const Rigid3& hand_from_patient,
                           const PosedModel& model, const Skeleton& skeleton,
                           std::vector<std::string>& notes) {
  std::vector<Bone> bones = model.sized.bones;
  std::vector<TriangleMesh> meshes = bones_at(model, skeleton);
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
    notes.push_back(
        "Bones that the scan doesn't show are the model's, moved along: " + listed(missing) + ".");
  }
  return bones;
}

}  // namespace

ScannedHand make_scanned_hand(const Hand& model, const std::map<ScanPosture, ScanSurfaces>& scans,
                              const MeasuredJoints& joints, const Progress& progress) {
  const auto reference = scans.find(ScanPosture::kReference);
  if (reference == scans.end()) {
    throw InputError("hand from scans: there is no scan of the reference posture");
  }
  const ScanSurfaces& scan = reference->second;
  const Hand base = model.side == scan.side ? model : mirrored(model);
  const Rigid3 hand_from_patient = joints.patient_from_hand.inverse();

  ScannedHand result;
  result.patient_from_hand = joints.patient_from_hand;
  RegisteredSkin registered =
      register_skin(base, skin_scan(scan, hand_from_patient), joints.skeleton, progress);
  result.registration_mean = registered.mean;
  result.registration_p95 = registered.percentile_95;
  constexpr double kWholeShare = 0.97;
  if (registered.partner_share < kWholeShare) {
    result.notes.push_back(
        fmt::format("{:.0f} % of the hand's skin isn't in the scan (touching fingers, spots, "
                    "holes); there it follows its surroundings.",
                    100.0 * (1.0 - registered.partner_share)));
  }

  Hand& hand = result.hand;
  hand.name = "scanned";
  hand.side = scan.side;
  hand.skeleton = joints.skeleton;
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    hand.skeleton.fingertips[static_cast<std::size_t>(f)] =
        fingertip_of(registered.skin, base.segment, hand.skeleton, finger);
  }
  SkinPartition partition =
      partition_skin({std::move(registered.skin), base.skin.triangles}, hand.skeleton);
  hand.skin = std::move(partition.skin);
  hand.segment = std::move(partition.segment);
  hand.region = std::move(partition.region);
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    hand.skeleton.fingertips[static_cast<std::size_t>(f)] =
        fingertip_of(hand.skin.vertices, hand.segment, hand.skeleton, finger);
  }
  hand.weights = make_joint_weights(hand.skin, hand.skeleton);
  hand.bones = bones_of(scan, hand_from_patient, registered.start, hand.skeleton, result.notes);
  hand.dimensions = measure_hand(hand);
  hand.tissue = default_tissue();
  hand.provenance =
      "skin, bones and joints from scans of a person; triangles laid over the skin "
      "by registration of: " +
      base.provenance;
  return result;
}

}  // namespace palmar
