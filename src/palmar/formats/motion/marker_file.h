// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/types.h"

namespace palmar::formats {

/// Positions of markers over time, mm.
struct MarkerRecording {
  struct Frame {
    int number = 1;                             ///< as the file counts
    std::optional<double> time;                 ///< s
    std::vector<std::optional<Vec3>> position;  ///< per label; nothing where it was not seen
  };
  std::vector<std::string> labels;
  std::vector<Frame> frames;
  std::string format;              ///< "C3D (Intel, float)", "CSV"
  std::vector<std::string> notes;  ///< what was skipped or doubted, with counts
};

/// Reads C3D (c3d.h) or CSV; what the file holds decides, not its name. CSV: one row per frame,
/// three columns per marker, LABEL_x_mm, LABEL_y_mm, LABEL_z_mm (or _cm, _m, _in), beside frame and
/// time_s; an empty cell or nan is a marker not seen.
///
/// `unit`: what the file's numbers are, over what the file says; then the columns of a CSV may also
/// be called LABEL_x.
///
/// Throws InputError naming file, place and what is needed.
MarkerRecording read_markers(const std::string& path,
                             std::optional<geometry::LengthUnit> unit = {});

}  // namespace palmar::formats
