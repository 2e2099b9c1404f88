// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/joints/measured_joints.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::capture {

/// Mean distance from the model's posed skin round the thumb ball to the scanned one (Xie 2014,
/// table 2-5), mm.
struct SkinError {
  hand::ScanPosture posture{};
  double skinning_only = 0.0;
  std::optional<double> corrected;   ///< with the hand's thumb-ball correction
  std::optional<double> by_markers;  ///< were it by the markers alone, as in the thesis
};

/// A person's hand, made from scans.
struct ScannedHand {
  hand::Hand hand;
  geometry::Rigid3 patient_from_hand;
  double registration_mean = 0.0;  ///< distance of the hand's skin to the reference scan's, mm
  double registration_p95 = 0.0;
  std::vector<SkinError> skin_errors;
  std::vector<std::string> notes;
};

/// Registers the skin of `model` to that of the reference scan (segments, regions, creases and
/// skinning come along), puts the scan's bones and joints in, and corrects the thumb ball by the
/// markers of the limit postures. Works without markers and limit postures, and says what is lost.
/// `scans` holds kReference at least. A model of the other side is mirrored. Scans that show skin
/// only work as well, given joints.skeleton from elsewhere; bones are the model's then. Throws
/// InputError without a reference scan, or if skin and joints don't belong together; Cancelled.
ScannedHand make_scanned_hand(const hand::Hand& model,
                              const std::map<hand::ScanPosture, ScanSurfaces>& scans,
                              const MeasuredJoints& joints, const Progress& progress = {});

}  // namespace palmar::capture
