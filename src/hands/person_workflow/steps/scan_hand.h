// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/scan/hand_from_scan.h"
#include "hands/capture/scan/skin_marks.h"
#include "hands/person_report/hand_scan_report.h"
#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::person_workflow {

/// How a hand is made of surfaces, whether they were scanned or photographed.
struct ScanHandOptions {
  std::string out;                 ///< the hand, *.hand.glb
  std::string work;                ///< folder for the report; empty: beside the hand
  std::string model = "template";  ///< hand whose segments, regions and joints are aligned with the
                                   ///< surface: "template" or a *.hand.glb file
  std::string name;                ///< of the hand; empty: that of the file
  std::optional<hand::Side> side;  ///< nothing: found from the shape
  capture::SkinMarkOptions inks;   ///< colours of the drawn creases and dots, diameter of the dots
  std::string marks;  ///< file with names of drawn marks, those to leave out and to add: marks.csv
                      ///< of an earlier run, edited; empty: none
  std::string known;  ///< file of what is known of the person (read_person()); its side and marks
                      ///< count where `side` isn't set and beside `marks`; empty: none
  bool looks_only = false;  ///< end with what was found on the surfaces: found.png, found.toml
  std::string truth;        ///< subject.json of a synthetic person, for the report; empty: none
  bool writes_report = true;
  Language language = Language::kEnglish;  ///< of the report

  void check() const;  ///< throws UsageError: setting, value, what is allowed
  /// Refuses what can't be written to and files that can't be read, before the long work. The
  /// folder `work` is made if somebody named it and there is a report. Throws InputError,
  /// OutputError.
  void check_files() const;
};

struct ScanHandOutcome {
  capture::HandFromScan made;  ///< with the notes of every step; nothing of a hand if only looked
                               ///< at
  std::string report;          ///< page; empty: none was written
  std::string found;           ///< sheet of what was found, found.png; empty: none was written
};

/// Surfaces to the hand that `options` name, with the report in `work`. `shown`: surfaces in mm
/// with the marks that were found on them. Before anything is computed on these, they are shown by
/// number in `work` (found.png, found.toml to be edited), if there is a report or nothing else is
/// wanted. `notes` come before those of this step. Throws
/// InputError, OutputError, Cancelled.
ScanHandOutcome make_hand_of_surfaces(
    const ScanHandOptions& options, const std::string& work,
    const std::map<hand::ScanPosture, person_report::ShownScan>& shown,
    const std::vector<std::string>& notes, const Progress& progress);

}  // namespace palmar::person_workflow
