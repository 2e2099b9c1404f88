// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palmar {

/// Which way an index is better.
enum class Better { kUp, kDown, kNeither };
std::string name_of(Better better);  ///< "up", "down", "neither"

/// One index of a grasp with everything that a reader needs to understand it. Indices are never
/// added up to one number.
struct GraspIndex {
  std::string key;              ///< in JSON, with its unit: "epsilon_l1", "skin_above_50_kpa_mm2"
  std::string name;             ///< for people: "largest disturbance held, any direction (L1)"
  std::string group;            ///< "stability", "ease", "fitness", "comfort", "effort", "reach"
  std::optional<double> value;  ///< nothing: can't be said for this grasp; `remark` says why
  std::string unit;             ///< "", "mm", "N", "kPa", "%"
  std::optional<double> lowest, highest;  ///< range of possible values, where there is one
  Better better = Better::kNeither;
  std::string definition;  ///< one sentence, with the equation's name
  std::string source;      ///< author, year
  std::string remark;      ///< what restricts this value, or empty
};
using GraspIndices = std::vector<GraspIndex>;

}  // namespace palmar
