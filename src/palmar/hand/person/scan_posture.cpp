// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/person/scan_posture.h"

#include <array>
#include <cctype>
#include <string>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

constexpr std::array<std::string_view, kScanPostureCount> kNames = {
    "reference",       "thumb_flexion",  "thumb_extension",  "thumb_abduction",
    "thumb_adduction", "finger_flexion", "finger_abduction", "grasp"};

}  // namespace

std::string_view name_of(ScanPosture posture) { return kNames[index_of(posture)]; }

std::optional<ScanPosture> scan_posture_in(std::string_view description) {
  std::string plain;
  for (const char c : description) {
    const bool is_gap = c == ' ' || c == '-' || c == '.';
    plain += is_gap ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  std::optional<ScanPosture> found;
  for (int k = 0; k < kScanPostureCount; ++k) {
    if (plain.find(kNames[k]) == std::string::npos) continue;
    if (found) return std::nullopt;  // names two
    found = static_cast<ScanPosture>(k);
  }
  return found;
}

}  // namespace palmar::hand
