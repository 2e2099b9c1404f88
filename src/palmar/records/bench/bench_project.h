// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/grip.h"
#include "palmar/hand/posture.h"

namespace palmar::records {

/// What is done from a pose that was set by hand on the bench.
enum class BenchSettle { kAsPlaced, kClose, kRest };

/// Hand and product as they were set by hand.
struct BenchPose {
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
  std::optional<grasp::Grip> grip;
};

/// The file that the workbench saves (.palmar-project): a product and how it is held. JSON:
///
///     {"palmar_project": 1,
///      "product": {"file_name": "cup.stl", "unit": "mm" or null, "bytes_base64": "..."},
///      "hand": {"person": "woman:P5" or null, "left": false,
///               "file": null (or absent) or {"file_name": "anna.hand.glb", "bytes_base64":
///               "..."}},
///      "grip_force_n": 60 or null, "hold": 1,
///      "pose": null or {"posture_deg": [23], "quaternion_wxyz": [4], "translation_mm": [3],
///      "grip"}, "settle": null, "close" or "rest"}
struct BenchProject {
  std::string file_name;                     ///< of the product; without folders
  std::optional<geometry::LengthUnit> unit;  ///< of the product's file, as the user said
  std::string bytes;                         ///< the product's file
  std::string person;                        ///< by sex and size, "woman:P5"; "": the template
  std::string hand_file, hand_bytes;         ///< a person's own hand in place of it; "": none
  bool is_left = false;
  std::optional<double> grip_force;  ///< N; unset: the usual one
  int hold = 1;                      ///< number in the list of holds; used without a pose
  std::optional<BenchPose> pose;
  BenchSettle settle = BenchSettle::kAsPlaced;  ///< of the pose
};

inline constexpr std::string_view kBenchProjectEnding = ".palmar-project";

/// Throws InputError without the file's name: what member is wrong, and what is required.
BenchProject parse_bench_project(std::string_view text);
/// Throws InputError naming the file.
BenchProject read_bench_project(const std::filesystem::path& file);

}  // namespace palmar::records
