// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/person_workflow/steps/scan_hand.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/types.h"

namespace palmar::person_workflow {

/// A person's hand from surface scans of any scanning app or photogrammetry program, with drawn
/// creases and dots if there are any (docs/method/scan.md).
struct HandFromScanRequest {
  /// Coloured surfaces (OBJ with its texture, GLB, PLY, STL), a file per posture. The file's name
  /// shows it: reference (or natural), finger_flexion, finger_abduction; the reference is needed, a
  /// single file is taken for it.
  std::vector<std::string> scans;
  std::map<std::string, hand::ScanPosture> posture;  ///< of files whose names don't give it
  std::optional<geometry::LengthUnit> unit;  ///< of files that carry none; nothing: the one that
                                             ///< makes a hand of the reference, which holds for all
  /// Points of the reference scan, in its own coordinates and unit, that have an ink's colour;
  /// nothing: `hand.inks` counts.
  std::optional<Vec3> pick_crease, pick_dot;
  ScanHandOptions hand;  ///< report: beside the hand, *.scan

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

/// Scans to hand and report; about 20 s of one core per scan. Throws UsageError; InputError naming
/// the scan: no hand in it, no unit fits, an ink is like the skin; OutputError; Cancelled.
ScanHandOutcome make_hand_from_scan(const HandFromScanRequest& request,
                                    const Progress& progress = {});

}  // namespace palmar::person_workflow
