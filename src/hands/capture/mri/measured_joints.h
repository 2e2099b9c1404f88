// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/mri/bones/image_registration.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/registration/icp.h"
#include "palmar/hand/person/scan_posture.h"
#include "palmar/hand/skeleton.h"

namespace palmar::capture {

/// The fixed axis that describes a rigid motion best: R u = u, (E - R) p = t with the component of
/// t along u dropped (Xie 2014, eq. 2-2 to 2-4).
struct AxisFit {
  Vec3 axis = Vec3::UnitX();  ///< unit; the turn about it is `angle` >= 0
  Vec3 point = Vec3::Zero();  ///< on the axis, nearest to where it was looked for
  double angle = 0.0;         ///< rad, [0, pi]
  double slide = 0.0;        ///< of the motion along the axis, which a pure rotation can't make, mm
  bool is_observed = false;  ///< the angle is large enough to determine an axis
};
/// `motion` of the distal part relative to the proximal one; `near`: where the joint is, mm.
AxisFit fit_axis(const geometry::Rigid3& motion, const Vec3& near);

/// A bone of the reference scan found again in the scan of another posture.
struct BoneMotion {
  std::string bone;
  std::string counterpart;  ///< its name in the other scan: another one if labels disagree
  geometry::Rigid3 posture_from_reference;       ///< patient frame of one scan to that of the other
  geometry::IcpResult fit;                       ///< surface to surface; 0 without is_cut_out
  std::optional<ImageFit> image = std::nullopt;  ///< what the motion is from, if images show it
  bool is_cut_out = true;                        ///< the other scan has a surface for it
};

/// Images of two scans, where there are any.
struct TrackedImages {
  const BoneImages* reference = nullptr;  ///< of the reference's bones
  const ImageLevels* posture = nullptr;   ///< the other scan
};

/// Finds every bone of `reference` in `posture` by registration along the chain from the carpus
/// out: each bone starts where its proximal neighbour's motion and the bone of the same name put
/// it. A bone that doesn't fit the one of its name is tried on others near where it must be
/// (counterpart). With `images` the motions are those that align the reference's intensities on the
/// other scan's (image_registration.h), and what has no surface there is searched for in the image
/// by turning it about its joint. Bones that aren't found are left out.
std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const TrackedImages& images, const Progress& progress = {});
std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const Progress& progress = {});

/// Mean distance of a bone's vertices moved by the model to where the scan shows them (Xie 2014,
/// tables 2-2 to 2-4), mm.
struct BoneError {
  hand::ScanPosture posture{};
  std::string bone;
  double icp = 0.0;                        ///< free rigid motion: the lower limit
  double single_axis = 0.0;                ///< every joint a fixed axis
  std::optional<double> interpolated_cmc;  ///< thumb only: CMC by its limit postures
};

/// Joints of a person from bones in several postures.
struct MeasuredJoints {
  hand::Skeleton skeleton;             ///< hand frame of the reference scan
  geometry::Rigid3 patient_from_hand;  ///< where that frame is
  std::array<bool, hand::kDofCount>
      is_measured{};  ///< axis and range come from the scans; others from the model
  /// Standard errors of measured axes (HingeFit::axis_error), rad; nothing where there is none.
  std::array<std::optional<double>, hand::kDofCount> axis_error{};
  std::map<hand::ScanPosture, hand::Posture> postures;  ///< angles of every posture
  /// Where the palm is in other scans, as far as something else than its bones showed.
  std::map<hand::ScanPosture, geometry::Rigid3> patient_from_hand_in = {};
  std::vector<BoneError> errors;
  std::vector<std::string> notes;  ///< what is lost for want of a posture or bone: sentences
};

/// `scans`: kReference at least; `motions`: those of the bones in every other posture that was
/// scanned. `model`: joints that the scans don't show are taken over from it, fitted to the bones.
/// Throws InputError if the reference scan lacks, or shows too few bones to determine where the
/// hand is.
MeasuredJoints measure_joints(const std::map<hand::ScanPosture, ScanSurfaces>& scans,
                              const std::map<hand::ScanPosture, std::vector<BoneMotion>>& motions,
                              const hand::Hand& model);

}  // namespace palmar::capture
