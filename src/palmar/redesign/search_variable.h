// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace palmar::redesign {

/// A feature's size that the search may choose, in its own unit.
struct SearchVariable {
  std::string name;  ///< "fillet:long", "diameter_mm"
  std::string unit;  ///< "mm", "deg", ""
  double lowest = 0.0, highest = 0.0;
  double start = 0.0;
  double step = 0.05;  ///< of the machine: values are rounded to whole steps from `lowest`
};

/// Whole steps of the machine from the lowest value of each variable.
using SearchSteps = std::vector<long>;

/// The steps nearest to a place, which has 0 for the lowest and 1 for the highest value of each
/// variable; what lies outside counts as on the border.
SearchSteps steps_at(const std::vector<SearchVariable>& variables, std::span<const double> place);
std::vector<double> values_at(const std::vector<SearchVariable>& variables,
                              const SearchSteps& steps);
/// Where values lie, each within [0, 1].
std::vector<double> place_of(const std::vector<SearchVariable>& variables,
                             const std::vector<double>& values);
/// "width 34, taper -2.5"
std::string words_of(const std::vector<SearchVariable>& variables,
                     const std::vector<double>& values);

}  // namespace palmar::redesign
