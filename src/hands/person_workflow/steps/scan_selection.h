// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/images/dicom.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::person_workflow {

/// An image and the posture that it shows.
struct SelectedScan {
  hand::ScanPosture posture{};
  std::string path;             ///< DICOM folder or image file
  images::SeriesChoice choice;  ///< of the folder's series
  std::string title;            ///< for people: "series 3 \"T1 thumb flexion\" of scans/"
  std::vector<std::string> files;
  bool has_surfaces = false;  ///< `path` is a folder of `palmar mri surfaces`, no image
};

/// What a series shows, as the user says.
struct SeriesPosture {
  std::string which;  ///< number of the series, or part of its description or of the file's name
  hand::ScanPosture posture{};
};

struct ScanSelection {
  std::vector<SelectedScan> scans;  ///< ascending posture
  std::vector<std::string> notes;   ///< series passed over, and why
};

/// Looks for the postures of scan_posture.h among images: each of `paths` is an image file, a
/// folder of DICOM series, or a folder (or one of several such) that `palmar mri surfaces` made. A
/// series shows the posture that its description names, else the one that the folder of its files
/// names; `assigned` says it for a series by number or part of its description, or for a file by
/// its name, and counts more; `skipped` postures are left out. A single image is the reference.
///
/// Throws InputError or UsageError, naming the series, if: nothing is there, none is the reference,
/// two show one posture, an assignment fits none.
ScanSelection select_scans(const std::vector<std::string>& paths,
                           const std::vector<SeriesPosture>& assigned,
                           const std::vector<hand::ScanPosture>& skipped);

}  // namespace palmar::person_workflow
