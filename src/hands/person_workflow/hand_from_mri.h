// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hands/capture/mri/scan_surfaces.h"
#include "hands/capture/scan/scan_record.h"
#include "hands/person_workflow/steps/scan_selection.h"
#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/core/setting_names.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/workflow/note/note.h"

namespace palmar::person_workflow {

/// A person's hand from MR series of it in several postures (docs/method/mri.md).
struct HandFromMriRequest {
  /// Images: folders of DICOM series, NIfTI files, or folders that find_mri_surfaces()
  /// made. The description of a series, or the name of its folder, shows the posture; the reference
  /// is needed.
  std::vector<std::string> images;
  std::vector<SeriesPosture> series;    ///< what series show whose names don't give it
  std::vector<hand::ScanPosture> skip;  ///< postures to leave out, for a spoilt series
  std::string out;                      ///< the hand, *.hand.glb
  std::string work;    ///< folder for the report and for what each step makes, which another run
                       ///< takes up; empty: beside the hand, *.mri
  std::string labels;  ///< file with names for bones of the reference scan; empty: none
  std::string known;   ///< file of what is known of the person (read_person()): its side counts
                       ///< where `surfaces` has none, its bones where `labels` doesn't name them;
                       ///< empty: none
  bool looks_only = false;  ///< end with the reference's bones: found.png, found.toml
  std::string product;      ///< what the grasp holds, in the patient frame of its scan; empty:
                            ///< nothing is compared
  std::optional<geometry::LengthUnit> unit;  ///< of the product's file, where that carries none
  std::string model = "template";    ///< hand to start from: "template" or a *.hand.glb file
  std::string name;                  ///< of the hand; empty: that of the file
  capture::SurfaceOptions surfaces;  ///< how skin and bones are found; whose hand it is
  bool accepts_odd_slices = false;  ///< a damaged slice spoils the surfaces near it, so going on is
                                    ///< a choice
  bool writes_report = true;
  Language language = Language::kEnglish;  ///< of the report

  SettingNames setting_names;  ///< for the notes that hand and report keep
  workflow::NoteSink note;     ///< gets every note once it is known; may be empty

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct HandFromMriOutcome {
  capture::ScanRecord record;  ///< the hand and how far it lies from the scans; notes
  std::string work;            ///< folder of what each step made
  std::string report;          ///< page; empty: none was written
  std::string found;  ///< sheet of the reference's bones, found.png; empty: none was written
};

/// Images to hand and report; minutes per posture. What an earlier run kept in the work folder is
/// taken up where all that goes into it is the same. Throws UsageError; InputError naming series or
/// file, also when a scan shows too few bones; NumericalError; OutputError; Cancelled (what was
/// finished is kept). A step that fails once the reference's surfaces are there is named, and the
/// report shows what was found until then (write_refused_scan_report()); no hand is written. Before
/// anything is computed on the reference's bones, they are shown by number in the work folder
/// (found.png, found.toml to be edited), if there is a report or nothing else is wanted.
HandFromMriOutcome make_hand_from_mri(const HandFromMriRequest& request,
                                      const Progress& progress = {});

}  // namespace palmar::person_workflow
