// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "hands/capture/scan/skin_marks.h"
#include "palmar/hand/person/person_labels.h"

namespace palmar::capture {

/// Names, takes away and adds marks. A mark is found by its place: a dot's centre or ink of a line
/// within 3 mm. Throws InputError "file:line: ..." if there is none (with the distance to the
/// nearest), if a dot is named twice, if the posture wasn't scanned or has no colours, if creases
/// are named in another posture than the reference, or if what is added of a crease is narrower
/// than 5 mm, which shows no direction.
void apply_mark_labels(const std::vector<hand::MarkLabel>& labels,
                       std::map<hand::ScanPosture, SkinMarks*>& marks);

/// A mark as it was taken.
struct TakenMark {
  hand::ScanPosture posture = hand::ScanPosture::kReference;
  hand::MarkLabel::Kind kind = hand::MarkLabel::Kind::kDot;
  std::optional<hand::Segment> segment;  ///< none: not used
  Vec3 point = Vec3::Zero();             ///< scan, mm
};

}  // namespace palmar::capture
