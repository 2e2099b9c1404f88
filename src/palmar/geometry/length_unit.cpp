// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/length_unit.h"

#include "palmar/core/error.h"

namespace palmar {

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

LengthUnit length_unit(const std::string& name) {
  if (name == "mm") return LengthUnit::kMillimetre;
  if (name == "cm") return LengthUnit::kCentimetre;
  if (name == "m") return LengthUnit::kMetre;
  if (name == "inch" || name == "in") return LengthUnit::kInch;
  throw UsageError("length unit is \"" + name + "\"; mm, cm, m or inch is required");
}

}  // namespace palmar
