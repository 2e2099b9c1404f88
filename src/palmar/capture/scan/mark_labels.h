// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/capture/mri/scan_posture.h"
#include "palmar/capture/scan/skin_marks.h"

namespace palmar {

/// What a person wrote about a mark on a scan.
struct MarkLabel {
  enum class Kind { kCrease, kDot };
  ScanPosture posture = ScanPosture::kReference;
  Kind kind = Kind::kDot;
  bool is_added = false;           ///< there is no ink; else a mark that was found is there
  std::optional<Segment> segment;  ///< a dot's; behind a crease, palm: the wrist's. None: no mark
  Vec3 point = Vec3::Zero();       ///< scan, mm
  std::string place;               ///< "file:line"
};

/// Names, takes away and adds marks. A mark is found by its place: a dot's centre or ink of a line
/// within 3 mm. Throws InputError "file:line: ..." if there is none (with the distance to the
/// nearest), if a dot is named twice, if the posture wasn't scanned or has no colours, if creases
/// are named in another posture than the reference, or if what is added of a crease is narrower
/// than 5 mm, which shows no direction.
void apply_mark_labels(const std::vector<MarkLabel>& labels,
                       std::map<ScanPosture, SkinMarks*>& marks);

/// A mark as it was taken.
struct TakenMark {
  ScanPosture posture = ScanPosture::kReference;
  MarkLabel::Kind kind = MarkLabel::Kind::kDot;
  std::optional<Segment> segment;  ///< none: not used
  Vec3 point = Vec3::Zero();       ///< scan, mm
};

}  // namespace palmar
