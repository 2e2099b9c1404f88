// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/population/population.h"
#include "palmar/records/person/mark_text.h"

namespace palmar::records {

/// What somebody knows of one person's hand: what corrects what the program finds in images, scans
/// and photographs of it.
struct PersonFile {
  std::optional<hand::Side> side;
  std::optional<Vec3> pick_crease, pick_dot;  ///< HandFromScanRequest
  std::vector<hand::MarkLabel> marks;         ///< on scans and photographs
  std::vector<hand::BoneLabel> bones;         ///< in the reference image
  std::vector<hand::SizedDimension> sizes;    ///< measured by hand, mm

  bool is_empty() const;  ///< says nothing
};

/// `person` and what `more` says: its side, points and sizes count, its marks and bones come after.
PersonFile merged(PersonFile person, const PersonFile& more);

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
/// All of it may be missing; a mark or bone without a name changes nothing. Throws InputError
/// naming file, line, key and what is allowed.
PersonFile read_person(const std::string& path);
inline constexpr std::uint64_t kMostPersonBytes = 1 << 20;
/// The same of a text; `path` is for messages.
PersonFile parse_person(const std::string& text, const std::string& path);

/// The text of such a file. Read again it gives the same, `place` apart, to the last digit.
std::string format_person(const PersonFile& person);
/// One mark or bone of it; a comment, in one line, stands behind its head.
std::string format_person_mark(const MarkText& mark, std::string_view comment = {});
std::string format_person_bone(const hand::BoneLabel& bone, std::string_view comment = {});

}  // namespace palmar::records
