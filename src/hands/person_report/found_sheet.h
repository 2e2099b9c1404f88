// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hands/capture/scan/mark_labels.h"
#include "hands/person_report/hand_scan_report.h"
#include "palmar/report/picture/image.h"
#include "palmar/report/picture/render.h"

namespace palmar::person_report {

/// A scan in its colours, in its own frame.
report::SceneObject coloured_surface(const ShownScan& scan);

/// A mark that was found on a scan, before anything is computed on it.
struct NumberedMark {
  int number = 0;  ///< from 1, over all scans
  hand::ScanPosture posture{};
  hand::MarkLabel::Kind kind{};
  Vec3 point = Vec3::Zero();             ///< scan, mm
  std::optional<hand::Segment> segment;  ///< as somebody named it; a crease's palm: the wrist's
};

/// Dots, then pieces of lines of 2 mm^2 or more, posture by posture.
std::vector<NumberedMark> numbered_marks(const std::map<hand::ScanPosture, ShownScan>& scans);

/// One sheet: every scan from its two broad sides in a row, with the numbers of the dots (red) and
/// lines (blue) that are seen from there; a count of each in the row's head. `progress` may cancel.
report::Image found_sheet(const std::map<hand::ScanPosture, ShownScan>& scans,
                          const std::vector<NumberedMark>& marks, const Progress& progress = {});

/// The same marks as a file that read_person() reads once names are written in.
std::string found_toml(const std::vector<NumberedMark>& marks);

}  // namespace palmar::person_report
