// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/search_variable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palmar::redesign {

SearchSteps steps_at(const std::vector<SearchVariable>& variables, std::span<const double> place) {
  SearchSteps steps;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const SearchVariable& variable = variables[i];
    const double range = variable.highest - variable.lowest;
    const long last = static_cast<long>(std::floor(range / variable.step + 1e-9));
    steps.push_back(
        std::clamp(std::lround(std::clamp(place[i], 0.0, 1.0) * range / variable.step), 0L, last));
  }
  return steps;
}

std::vector<double> values_at(const std::vector<SearchVariable>& variables,
                              const SearchSteps& steps) {
  std::vector<double> values;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    values.push_back(variables[i].lowest + static_cast<double>(steps[i]) * variables[i].step);
  }
  return values;
}

std::vector<double> place_of(const std::vector<SearchVariable>& variables,
                             const std::vector<double>& values) {
  std::vector<double> place;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const SearchVariable& variable = variables[i];
    place.push_back(
        std::clamp((values[i] - variable.lowest) / (variable.highest - variable.lowest), 0.0, 1.0));
  }
  return place;
}

std::string words_of(const std::vector<SearchVariable>& variables,
                     const std::vector<double>& values) {
  std::string words;
  for (std::size_t i = 0; i < values.size(); ++i) {
    words += fmt::format("{}{} {:.4g}", i == 0 ? "" : ", ", variables[i].name, values[i]);
  }
  return words;
}

}  // namespace palmar::redesign
