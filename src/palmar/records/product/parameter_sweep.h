// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "palmar/records/product/made_product.h"

namespace palmar::records {

inline constexpr std::size_t kMostVariants = 1000;  // of one product

/// from, from + step ... up to `to`, which is among them if the steps reach it. Throws UsageError
/// naming the parameter: a step that isn't above 0, `to` below `from`, too many values.
std::vector<double> sweep_values(const std::string& parameter, double from, double to, double step);
/// "35", "25:60:2.5" (from:to:step) or "30,35,45". Throws UsageError naming the parameter.
std::vector<double> parse_sweep(const std::string& parameter, const std::string& text);

/// A product whose parameters take several values: with two or more such, every one of the first
/// with every one of the second.
struct MadeSweep {
  std::string kind;
  std::vector<std::pair<std::string, std::vector<double>>> given;  ///< parameter and its values
};

struct MadeVariant {
  MadeProduct product;
  /// What distinguishes it from the others: "diameter 25 mm", "diameter 25 mm taper 2 deg"; "" of
  /// the only one.
  std::string suffix;
};

/// In the order of the values, the last parameter fastest. Throws UsageError: as made_from(), and
/// on more than kMostVariants.
std::vector<MadeVariant> variants_of(const MadeSweep& sweep);

}  // namespace palmar::records
