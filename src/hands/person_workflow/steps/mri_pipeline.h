// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/mri/bones/bone_labels.h"
#include "hands/capture/scan/scan_record.h"
#include "hands/person_workflow/steps/scan_selection.h"
#include "palmar/core/progress.h"
#include "palmar/core/setting_names.h"
#include "palmar/product/product.h"
#include "palmar/workflow/note/note.h"

namespace palmar::person_workflow {

struct MriPipelineOptions {
  capture::SurfaceOptions surfaces;         ///< its side counts; none: from the anatomy
  std::vector<hand::BoneLabel> labels;      ///< of the reference scan
  bool accepts_odd_slices = false;          ///< goes on though a slice seems damaged
  std::string work;                         ///< folder of what each step made
  std::optional<product::Product> product;  ///< what the grasp held, in the patient frame of its
                                            ///< scan Called with each note as soon as it is known;
                                            ///< may be empty.
  workflow::NoteSink note;
  SettingNames setting_names;  ///< for notes; exceptions name settings in the library's words
  /// Called with the reference's surfaces and names before anything is computed on them, also if a
  /// label is then refused; may be empty.
  std::function<void(const capture::ScanSurfaces&, const Progress&)> show_reference;
  bool looks_only = false;  ///< ends there
  /// The last step, which writes hand and report.
  std::function<void(capture::ScanRecord&, const Progress&)> write;
  /// Called when a step fails after the reference's surfaces were found, with what was found so
  /// far; returns what the message shall say about it, or "". May be empty.
  std::function<std::string(const capture::ScanRecord&, const capture::ScanRefusal&)> write_found;
};

/// Images to a hand: surfaces of every scan (one after the other, each on all threads), bones from
/// posture to posture, joints, skin, contact with the product. What an earlier run kept in the work
/// folder is taken up where all that goes into it is the same. Throws InputError, also when a scan
/// shows too few bones to make a hand of, and NumericalError, both with the step that failed and
/// after `write_found`; Cancelled (what was finished is kept).
capture::ScanRecord run_mri_pipeline(const std::vector<SelectedScan>& scans,
                                     const hand::Hand& model, const MriPipelineOptions& options,
                                     const Progress& progress);

}  // namespace palmar::person_workflow
