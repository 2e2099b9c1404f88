// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/geometry/types.h"
#include "palmar/hand/anatomy.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::hand {

/// A name that somebody gives to the bone at a point of a person's images.
struct BoneLabel {
  std::string name;           ///< as Hand::bones has it
  Vec3 point = Vec3::Zero();  ///< in or near the bone; patient frame, mm
  std::string place;          ///< "labels.csv, line 3", for messages
};

/// What somebody wrote about a mark on a scan.
struct MarkLabel {
  enum class Kind { kCrease, kDot };
  ScanPosture posture = ScanPosture::kReference;
  Kind kind = Kind::kDot;
  bool is_added = false;           ///< there is no ink; else a mark that was found is there
  std::optional<Segment> segment;  ///< a dot's; behind a crease, palm: the wrist's. None: no mark
  Vec3 point = Vec3::Zero();       ///< scan, mm
  std::string place;               ///< "file:line"
};

}  // namespace palmar::hand
