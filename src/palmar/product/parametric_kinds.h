// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::product {

/// Values of a kind's parameters by their names, in the unit that the name ends with.
using KindValues = std::map<std::string, double>;

struct KindParameter {
  std::string name;  ///< ends with its unit: "diameter_mm", "taper_deg"; "flutes" is a count
  double fallback = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
  std::string meaning;    ///< a sentence for people
  bool is_whole = false;  ///< only whole numbers
};

/// What must hold between the parameters of a kind: `parameter` is at most (or at least) what
/// `bound` makes of the others.
struct KindRelation {
  std::string parameter;
  bool is_highest = true;
  std::function<double(const KindValues&)> bound;
  std::string words;  ///< how the bound comes about: "half of the smaller of width_mm and depth_mm"
};

/// A kind of product that is made from parameters. Long kinds lie along z, all about the origin;
/// the widths along x and depths along y. Data only: solids are made by make_kind_solid() of
/// module cad.
struct ParametricKind {
  std::string name;
  std::string description;
  std::vector<KindParameter> parameters;
  std::vector<KindRelation> relations;
  /// Along the grip to the side of thumb and index finger, unit; empty where the shape alone shows.
  /// A pistol grip without its frame doesn't: what stands on it, not its own mass, says which end
  /// is up.
  std::function<Vec3(const KindValues&)> thumb_side = {};
};

/// In the order in which people are informed of them.
const std::vector<ParametricKind>& parametric_kinds();
std::vector<std::string> parametric_kind_names();
/// Throws UsageError naming the nearest, and all.
const ParametricKind& parametric_kind(const std::string& name);

/// "mm", "deg", or "" of a count.
std::string unit_of_parameter(const std::string& parameter);

/// The given values, and the defaults of what isn't given. Throws UsageError naming kind,
/// parameter, value and what is allowed: an unknown parameter (with the nearest), one given twice,
/// a value outside of its range, a count that isn't whole, a relation that doesn't hold.
KindValues complete_values(const ParametricKind& kind,
                           const std::vector<std::pair<std::string, double>>& given);

}  // namespace palmar::product
