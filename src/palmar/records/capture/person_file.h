// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/capture/mri/bones/bone_labels.h"
#include "palmar/capture/scan/mark_labels.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/population/population.h"

namespace palmar {

/// What somebody knows of one person's hand: what corrects what the program finds in images, scans
/// and photographs of it.
struct PersonFile {
  std::optional<Side> side;
  std::optional<Vec3> pick_crease, pick_dot;  ///< HandFromScanRequest
  std::vector<MarkLabel> marks;               ///< on scans and photographs
  std::vector<BoneLabel> bones;               ///< in the reference image
  std::vector<SizedDimension> sizes;          ///< measured by hand, mm
};

/// Reads it from a TOML file, which people edit and all commands that make a person's hand take:
///
///     side = "left"
///     [scan]                        # points of the reference scan, in its coordinates and unit
///     pick_crease = [10.0, 80.0, 3.0]
///     pick_dot = [12.0, 85.0, -9.0]
///     [[mark]]                      # as found.toml lists them
///     posture = "reference"         # reference where it isn't given
///     mark = "dot"                  # crease, dot, added_crease, added_dot
///     name = "none"                 # a segment, "wrist", "palm"; "none": no mark
///     at_mm = [40.1, 88.0, -7.5]    # frame of the scan
///     [[bone]]
///     name = "scaphoid"
///     at_mm = [3.0, -12.5, 40.0]    # patient frame
///     [measured_mm]
///     hand_length = 181.0
///
/// All of it may be missing; a mark without a name changes nothing. Throws InputError naming file,
/// line, key and what is allowed.
PersonFile read_person(const std::string& path);

}  // namespace palmar
