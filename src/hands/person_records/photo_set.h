// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/photo/board_pattern.h"
#include "hands/capture/photo/lens_calibration.h"
#include "hands/images/exif.h"

namespace palmar::person_records {

/// A photograph of a set, as the set describes it.
struct PhotoFile {
  std::filesystem::path path;
  std::string camera;  ///< photographs of one camera have one lens
  int position = 0;    ///< of the rig: those of one were taken together; from 0 without gaps
  std::optional<images::PhotoExif> exif;  ///< what the camera says, if it does
};

struct PhotoSet {
  std::vector<PhotoFile> photographs;  ///< by position, then by camera
  capture::BoardPattern board;
  bool is_described = false;  ///< by photos.json or by the files' names
};

/// The photographs in a folder: what photos.json says,
///
///     {"board": {"squares": 11, "square_mm": 36, "marker_mm": 27},
///      "photographs": [{"file": "a.jpg", "camera": "left", "position": 0}, ...]}
///
/// or else every .png, .jpg and .jpeg file. Names like p3_c2.jpg say position and camera (any
/// other text may stand before, between them and behind); without such names each is in a position
/// of its own, and of the camera that it says it was taken with. Throws InputError naming folder or
/// entry, also if photographs of one camera say that they were taken with unlike cameras or focal
/// lengths.
PhotoSet read_photo_set(const std::filesystem::path& folder);
/// Whether a folder has photographs right in it.
bool holds_photographs(const std::filesystem::path& folder);
/// Where its photographs are, in their order.
std::vector<std::filesystem::path> paths_of(const PhotoSet& set);

/// Lenses by camera, as `palmar photos calibrate` writes them.
using PhotoLenses = std::map<std::string, capture::LensCalibration>;
PhotoLenses read_lenses(const std::filesystem::path& path);
std::string format_lenses(const PhotoLenses& lenses);

}  // namespace palmar::person_records
