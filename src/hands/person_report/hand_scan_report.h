// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "hands/capture/scan/scan_truth.h"
#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::person_report {

/// What a report shows of one scan.
struct ShownScan {
  std::string file;
  geometry::ColouredMesh surface;  ///< mm; colours may be empty
  capture::SkinMarks marks;
};

/// Writes into `folder`: report.html (works offline: what was scanned and found in it, with
/// pictures; how far the hand lies from the scan; joints and dimensions; notes), scan.json,
/// dimensions.csv, joints_by_dots.csv, marks.csv, scan_POSTURE.ply (the surfaces as they were used,
/// mm, in the frame of marks.csv), and with `errors` against a truth truth_errors.csv. The page is
/// in `language`, the files are English. Same input, same bytes. Throws OutputError, Cancelled.
void write_hand_scan_report(const std::string& folder, const capture::HandFromScan& made,
                            const std::map<hand::ScanPosture, ShownScan>& scans,
                            const std::optional<capture::ScanErrors>& errors = {},
                            Language language = Language::kEnglish, const Progress& progress = {});

}  // namespace palmar::person_report
