// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/types.h"

namespace palmar {

/// What a person's hand is made from: a hand file that is there already, measures or one
/// photograph, surface scans, photographs on the board, MR images.
enum class HandMethod { kFile, kQuick, kScan, kPhotos, kMri };
std::string name_of(HandMethod method);  ///< "file", "quick", "scan", "photos", "mri"

/// One row of what a person says of the marks on a scan (`palmar hand from-scan --marks`) or of the
/// bones of MR images (`palmar hand from-mri --labels`, without posture and mark).
struct HandCorrection {
  std::string posture, mark, name;
  Vec3 place = Vec3::Zero();  ///< mm, frame of the scan
};

/// A person's hand as a job (job_request.h):
///
///     {"kind": "hand", "method": "file" | "quick" | "scan" | "photos" | "mri", "uploads": KEY,
///      "name": "anna", "side": "right" | "left" | null, "unit": "mm" | null,
///      "crease_colour": "green", "dot_colour": "blue", "population": "ansur2_women",
///      "sheet": "a4" | "letter" | "card" | null, "wrist_inside_mm": 0, "palm_up": false,
///      "sizes_mm": {"hand_length": 181},
///      "corrections": [{"posture", "mark", "name", "place_mm": [x, y, z]}]}
///
/// Names are words of letters, digits, '_' and '-': none is a file of this machine or an option.
struct HandRequest {
  HandMethod method = HandMethod::kFile;
  std::string uploads;  ///< key of the files that were sent; "" of measures alone
  std::string name;
  std::string side, crease_colour, dot_colour, population, sheet;  ///< "": as commands have it
  std::optional<LengthUnit> unit;
  double wrist_inside = 0.0;  ///< mm
  bool is_palm_up = false;
  std::map<std::string, double> sizes;  ///< mm, by the names of `palmar hand measure`
  std::vector<HandCorrection> corrections;
};

/// Reads and writes those members. Throws UsageError naming the member, its value and what is
/// allowed.
HandRequest parse_hand_request(const nlohmann::ordered_json& json);
void write_hand_request(const HandRequest& request, nlohmann::ordered_json& json);

/// The command line, without the program's name; `folder` is in front of what is written, with '/'.
/// Reads kHandCorrections there if there are corrections.
std::vector<std::string> hand_words(const HandRequest& request,
                                    const std::vector<std::string>& sources,
                                    const std::string& folder, const std::string& language);
/// The file of corrections as that command reads it.
std::string corrections_csv(const HandRequest& request);
inline constexpr const char* kHandCorrections = "corrections.csv";
inline constexpr const char* kHandFound = "found";  ///< folder with what comes of it

/// Where the hand is, in a job's folder.
std::filesystem::path hand_result(const HandRequest& request,
                                  const std::vector<std::string>& sources);

/// Of files that were sent (paths relative to their folder, as std::filesystem sorts them), those
/// that the command is to be given: the meshes, the photograph, or the folder itself ("").
std::vector<std::string> hand_sources(HandMethod method, const std::vector<std::string>& files);

}  // namespace palmar
