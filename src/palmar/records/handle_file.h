// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "palmar/redesign/handle_shape.h"

namespace palmar::records {

inline constexpr int kHandleFileVersion = 1;

/// The features of a handle as a TOML file that people can read and edit
/// (docs/using/redesign.md).
///
///     version = 1
///     product = "prism"        # for information, as [frame]
///     [features]               # every feature by name and unit, handle_features.h; 0 if left out
///     width_mm = 34.2
///     twist_deg_per_100mm = 4.0
///     [ends]
///     end_radius_mm = 3.0
///     kept_mm = [0.0, 0.0]     # at bottom and top; or one number for both
///     kept_boxes_mm = []       # six coordinates for each: two corners, product frame
///     kept_faces = []          # CAD faces, by number or name
///     [frame]
///     origin_mm = [0.0, 0.0, 4.0]
///     along = [0.0, 0.0, 1.0]  # towards the thumb
///     palm = [0.0, 1.0, 0.0]   # towards the palm
std::string handle_toml(const redesign::HandleShape& shape, const std::string& product);

struct HandleFile {
  redesign::HandleFeatures features;
  double end_radius = 0.0;                       ///< mm
  std::array<double, 2> kept_ends = {0.0, 0.0};  ///< bottom and top, mm
  std::vector<Box3> kept_boxes = {};             ///< product frame, mm
  std::vector<std::string> kept_faces = {};      ///< by number or name
};
/// Width and depth are needed. Throws InputError naming file, line, key, value and what is allowed.
HandleFile read_handle(const std::filesystem::path& path);

/// "width_mm", "twist_deg_per_100mm", "egg".
std::string key_of(const redesign::HandleFeature& feature);

/// A FreeCAD macro (Python) that builds the same solid from the same sections, with the numbers to
/// edit on top.
std::string freecad_macro(const redesign::HandleShape& shape, const std::string& product);

}  // namespace palmar::records
