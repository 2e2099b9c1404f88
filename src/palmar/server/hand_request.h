// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/length_unit.h"
#include "palmar/records/person/person_file.h"

namespace palmar::server {

/// What a person's hand is made from: a hand file that is there already, measures or one
/// photograph, surface scans, photographs on the board, MR images.
enum class HandMethod { kFile, kQuick, kScan, kPhotos, kMri };
std::string name_of(HandMethod method);  ///< "file", "quick", "scan", "photos", "mri"

/// A person's hand as a job (job_request.h):
///
///     {"kind": "hand", "method": "file" | "quick" | "scan" | "photos" | "mri", "uploads": KEY,
///      "name": "anna", "side": "right" | "left" | null, "unit": "mm" | null,
///      "crease_colour": "green", "dot_colour": "blue", "population": "ansur2_women",
///      "sheet": "a4" | "letter" | "card" | null, "wrist_inside_mm": 0, "palm_up": false,
///      "sizes_mm": {"hand_length": 181},
///      "corrections": [{"posture", "mark", "name", "place_mm": [x, y, z]}],
///      "pick_crease": [x, y, z] | null, "pick_dot": [x, y, z] | null}
///
/// Side, sizes, corrections and points are what is known of the person: a correction with a mark is
/// one of a scan or of photographs, one without names a bone of MR images. What was added and is
/// called "none" was taken away again. Names are words of letters, digits, '_' and '-': none is a
/// file of this machine or an option.
struct HandRequest {
  HandMethod method = HandMethod::kFile;
  std::string uploads;  ///< key of the files that were sent; "" of measures alone
  std::string name;
  std::string crease_colour, dot_colour, population, sheet;  ///< "": as commands have it
  std::optional<geometry::LengthUnit> unit;
  double wrist_inside = 0.0;  ///< mm
  bool is_palm_up = false;
  records::PersonFile known;
};

/// Reads and writes those members. Throws UsageError naming the member, its value and what is
/// allowed.
HandRequest parse_hand_request(const nlohmann::ordered_json& json);
void write_hand_request(const HandRequest& request, nlohmann::ordered_json& json);

/// The command line, without the program's name; `folder` is in front of what is written, with '/'.
/// Reads kHandKnown there if something is known of the person.
std::vector<std::string> hand_words(const HandRequest& request,
                                    const std::vector<std::string>& sources,
                                    const std::string& folder, const std::string& language);
inline constexpr const char* kHandKnown = "person.toml";  ///< format_person()
inline constexpr const char* kHandFound = "found";        ///< folder with what comes of it

/// Where the hand is, in a job's folder.
std::filesystem::path hand_result(const HandRequest& request,
                                  const std::vector<std::string>& sources);

/// Of files that were sent (paths relative to their folder, as std::filesystem sorts them), those
/// that the command is to be given: the meshes, the photograph, or the folder itself ("").
std::vector<std::string> hand_sources(HandMethod method, const std::vector<std::string>& files);
/// The one that says what is known of the person, *.toml; nothing if there is none. Throws
/// UsageError naming them if there are several.
std::optional<std::string> known_source(const std::vector<std::string>& files);

}  // namespace palmar::server
