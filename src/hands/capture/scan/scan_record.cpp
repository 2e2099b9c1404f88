// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/scan_record.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace palmar::capture {
namespace {

/// Where a row stands among those of its posture: the thumb's, then the fingers' outwards.
int order_of(const std::string& row) {
  constexpr std::array<std::string_view, 6> kOrder = {
      "thumb_metacarpal",        "thumb_proximal_phalanx", "thumb_distal_phalanx",
      "proximal phalanges II-V", "middle phalanges II-V",  "distal phalanges II-V"};
  return static_cast<int>(std::find(kOrder.begin(), kOrder.end(), row) - kOrder.begin());
}

/// Which row a bone counts in; "" for none.
std::string row_of(const std::string& bone) {
  if (bone.rfind("thumb_", 0) == 0) return bone;
  for (const char* finger : {"index_", "middle_", "ring_", "little_"}) {
    if (bone.rfind(finger, 0) != 0) continue;
    for (const char* kind : {"proximal", "middle", "distal"}) {
      if (bone == std::string(finger) + kind + "_phalanx") {
        return std::string(kind) + " phalanges II-V";
      }
    }
  }
  return "";
}

}  // namespace

std::vector<ErrorRow> error_rows(const std::vector<BoneError>& errors) {
  std::vector<ErrorRow> rows;
  for (const BoneError& error : errors) {
    const std::string name = row_of(error.bone);
    if (name.empty()) continue;
    auto at = std::find_if(rows.begin(), rows.end(), [&](const ErrorRow& row) {
      return row.posture == error.posture && row.bones == name;
    });
    if (at == rows.end()) at = rows.insert(rows.end(), ErrorRow{error.posture, name, 0, 0, 0, {}});
    ++at->count;
    at->icp += error.icp;
    at->single_axis += error.single_axis;
    if (error.interpolated_cmc) {
      at->interpolated_cmc = at->interpolated_cmc.value_or(0.0) + *error.interpolated_cmc;
    }
  }
  for (ErrorRow& row : rows) {
    row.icp /= row.count;
    row.single_axis /= row.count;
    if (row.interpolated_cmc) *row.interpolated_cmc /= row.count;
  }
  std::stable_sort(rows.begin(), rows.end(), [](const ErrorRow& a, const ErrorRow& b) {
    return std::pair(a.posture, order_of(a.bones)) < std::pair(b.posture, order_of(b.bones));
  });
  return rows;
}

}  // namespace palmar::capture
