// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palmar::grasp {

/// Which way an index is better.
enum class Better { kUp, kDown, kNeither };
std::string name_of(Better better);  ///< "up", "down", "neither"

/// Share by which two results of a grasp must differ to be told apart: our choice. 5 % more of
/// a constant of the method moves the peak on sensor cells by less as a rule
/// (docs/method/sensitivity.md), and people tell two forces apart when they differ by about 7 %
/// (Jones 1989, Perception 18:681-687).
inline constexpr double kToldApart = 0.10;

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
  /// Two values that differ by less than this share of the larger can't be told apart.
  double told_apart = kToldApart;
};
using GraspIndices = std::vector<GraspIndex>;

}  // namespace palmar::grasp
