// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/hand/posture/posture_from_mesh.h"
#include "palmar/records/posture/posture_file.h"

namespace palmar::records {

/// A posture and how it was found.
struct FoundPosture {
  PostureFrame frame;
  int number = 1;                           ///< as the recording counts frames
  std::optional<hand::PostureFit> markers;  ///< found from markers
  std::optional<hand::MeshFit> mesh;        ///< found from a mesh
};

/// Postures of one measurement.
struct PostureReport {
  std::string hand;                 ///< name of the hand
  std::string source;               ///< file they come from
  std::vector<std::string> labels;  ///< of the markers, if there are
  std::vector<FoundPosture> postures;
};

/// One object {"hand", "source", "posture": {...}, ...}; several postures as "frames". With
/// markers: "measured_from_hand", "rms_mm", "residuals_mm" by label, "outliers", "swapped",
/// "not_observed", "at_limit", "sd_deg". With a mesh: "mesh_from_hand", "distance_mm" {mean,
/// median, percentile_95}, "partner_share". read_postures() reads it.
std::string posture_report_json(const PostureReport& report);

/// frame, time_s, the 23 angles, and rms_mm where there are markers.
std::string posture_report_csv(const PostureReport& report);

}  // namespace palmar::records
