// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/mri/bones/bone_tracking.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"
#include "palmar/hand/skeleton.h"

namespace palmar::capture {

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
