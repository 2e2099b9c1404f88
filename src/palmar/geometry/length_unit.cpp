// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/length_unit.h"

#include <array>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar::geometry {

std::string name_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return "mm";
    case LengthUnit::kCentimetre:
      return "cm";
    case LengthUnit::kMetre:
      return "m";
    case LengthUnit::kInch:
      return "inch";
  }
  return "";
}

double millimetres_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return 1.0;
    case LengthUnit::kCentimetre:
      return 10.0;
    case LengthUnit::kMetre:
      return 1000.0;
    case LengthUnit::kInch:
      return 25.4;
  }
  return 1.0;
}

std::optional<LengthUnit> length_unit_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, LengthUnit>, 8> kNames = {
      {{"mm", LengthUnit::kMillimetre},
       {"millimetre", LengthUnit::kMillimetre},
       {"cm", LengthUnit::kCentimetre},
       {"centimetre", LengthUnit::kCentimetre},
       {"m", LengthUnit::kMetre},
       {"metre", LengthUnit::kMetre},
       {"in", LengthUnit::kInch},
       {"inch", LengthUnit::kInch}}};
  std::string word = lower_case(name);
  if (word == "inches") return LengthUnit::kInch;
  if (word.ends_with("etres") || word.ends_with("eters")) word.pop_back();
  if (word.ends_with("eter")) word.replace(word.size() - 2, 2, "re");
  for (const auto& [known, unit] : kNames) {
    if (word == known) return unit;
  }
  return std::nullopt;
}

LengthUnit length_unit(const std::string& name) {
  if (const auto unit = length_unit_named(name)) return *unit;
  throw UsageError("length unit is \"" + name + "\"; mm, cm, m or inch is required");
}

}  // namespace palmar::geometry
