// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hands/person_workflow/steps/photo_cameras.h"
#include "hands/person_workflow/steps/scan_hand.h"
#include "palmar/core/progress.h"
#include "palmar/workflow/note/note.h"

namespace palmar::person_workflow {

/// A person's hand from photographs of it on the printed board (docs/method/photos.md).
struct HandFromPhotosRequest {
  /// A folder of photographs (.png, .jpg) per posture, or folders of such folders, of which one
  /// called calibration or lenses is where lenses come from if nothing else is said. The name gives
  /// the posture: reference (or natural), finger_flexion, finger_abduction; the reference is
  /// needed, a single folder is taken for it.
  std::vector<std::string> folders;
  std::map<std::string, hand::ScanPosture> posture;  ///< of folders whose names don't give it
  PhotoMeshOptions mesh;                             ///< how surfaces are made of the photographs
  ScanHandOptions hand;     ///< `work`: folder for the report and for the meshes, which another run
                            ///< takes up; empty: beside the hand, *.photos
  workflow::NoteSink note;  ///< gets what is there and how long it takes; may be empty

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

/// Photographs to meshes, hand and report; about 3 s of one core per photograph. Meshes of the same
/// photographs that an earlier run left are taken up. Throws UsageError; InputError naming folder
/// or photograph; OutputError; Cancelled (meshes that are finished are kept).
ScanHandOutcome make_hand_from_photos(const HandFromPhotosRequest& request,
                                      const Progress& progress = {});

}  // namespace palmar::person_workflow
