// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/capture/bone_labels.h"
#include "palmar/capture/scan_record.h"
#include "palmar/core/progress.h"
#include "scan_selection.h"

namespace palmar::cli {

struct MriPipelineOptions {
  SurfaceOptions surfaces;
  std::vector<BoneLabel> labels;  ///< of the reference scan
  std::optional<Side> side;       ///< else from the anatomy
  std::string work;               ///< folder of what each step made
};

/// Surfaces of one scan: from the work folder if image, options and program are those of an earlier
/// run, else from the image, and kept. Throws InputError, Cancelled.
RecordedScan surfaces_of(const SelectedScan& selected, const Hand& model,
                         const MriPipelineOptions& options, const Progress& progress);

/// Images to a hand: surfaces of every scan (one after the other, each on all threads), bones from
/// posture to posture, joints, skin. What was finished when the user cancelled is kept.
ScanRecord run_mri_pipeline(const std::vector<SelectedScan>& scans, const Hand& model,
                            const MriPipelineOptions& options, const Progress& progress);

}  // namespace palmar::cli
