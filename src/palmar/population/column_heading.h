// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "palmar/hand/dimensions/hand_dimension.h"

namespace palmar::population {

enum class Quantity {
  kLength,  ///< the heading names a unit of length
  kAge,     ///< "age", "age_years", "Age [y]", "age (months)"
  kLabel,   ///< of the person: "id", "subject", "no"
  kOther    ///< anything else, in its own unit or none
};

/// What the heading of a column in a table of subjects says: "Hand length [mm]", "handbreadth
/// (cm)", "index_proximal_length_in".
struct ColumnHeading {
  std::string name;  ///< of our dimension if it is one, else as written in small_letters
  std::optional<hand::HandDimension> dimension;  ///< known under this or another usual name
  Quantity quantity = Quantity::kOther;
  std::string unit;     ///< as named: "cm"; "" if none
  double factor = 1.0;  ///< what the unit is in mm (lengths) or years (ages)
};
ColumnHeading heading_of(std::string_view header);

/// Sizes [mm] that hands from two years of age on can have, with room; for finding wrong units.
struct SizeRange {
  double low = 0.0, high = 0.0;
};
/// By name: of the 47 dimensions, wrist_circumference; nothing for others.
std::optional<SizeRange> size_range(std::string_view name);

}  // namespace palmar::population
