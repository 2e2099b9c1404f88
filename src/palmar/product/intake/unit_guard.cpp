// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/unit_guard.h"

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar::product {
namespace {

constexpr double kSmallestSize = 0.1;     // mm; below, nothing can be felt
constexpr double kLargestSize = 10000.0;  // mm; above, nothing is held in a hand

/// "120 x 45.2 x 45.2"
std::string sides(const Vec3& size, double scale) {
  return significant(size.x() * scale, 4) + " x " + significant(size.y() * scale, 4) + " x " +
         significant(size.z() * scale, 4);
}

void check_size(const Vec3& size, geometry::LengthUnit unit, const std::string& object) {
  const double longest = size.maxCoeff() * geometry::millimetres_per(unit);
  if (longest >= kSmallestSize && longest <= kLargestSize) return;
  throw InputError(object + ": its size is " + sides(size, geometry::millimetres_per(unit)) +
                   " mm (" + sides(size, 1.0) + " in " + name_of(unit) +
                   "); the longest side must be " + significant(kSmallestSize, 4) + " to " +
                   significant(kLargestSize, 4) +
                   " mm. If the unit is wrong, give it by setting \"unit\": mm, cm, m or inch");
}

std::optional<geometry::LengthUnit> propose(double longest) {
  if (longest >= 0.04 && longest <= 0.6) return geometry::LengthUnit::kMetre;
  if (longest >= 1.6 && longest < 4.0) return geometry::LengthUnit::kInch;
  if (longest >= 40.0 && longest <= 2000.0) return geometry::LengthUnit::kMillimetre;
  return {};
}

}  // namespace

UnitDecision decide_unit(const Box3& box, std::optional<geometry::LengthUnit> from_file,
                         std::optional<geometry::LengthUnit> from_user, const std::string& object) {
  if (box.isEmpty()) throw InputError(object + ": no vertices, so no size");
  const Vec3 size = box.sizes();
  if (!size.allFinite()) {
    throw InputError(object + ": its size is " + sides(size, 1.0) +
                     " units; finite numbers are required");
  }
  const double longest = size.maxCoeff();
  if (longest == 0.0) {
    throw InputError(object + ": its size is 0 x 0 x 0 units: all vertices are at one point");
  }
  if (from_user) {
    check_size(size, *from_user, object);
    UnitDecision decision{*from_user, UnitSource::kUser, ""};
    if (from_file && *from_file != *from_user) {
      decision.explanation =
          "unit " + name_of(*from_user) + " as given, though the file says " + name_of(*from_file);
    }
    return decision;
  }
  if (from_file) {
    check_size(size, *from_file, object);
    return {*from_file, UnitSource::kFile, ""};
  }
  const std::optional<geometry::LengthUnit> proposed = propose(longest);
  if (!proposed) {
    std::string reading;
    for (const geometry::LengthUnit unit :
         {geometry::LengthUnit::kMillimetre, geometry::LengthUnit::kCentimetre,
          geometry::LengthUnit::kInch, geometry::LengthUnit::kMetre}) {
      reading += (reading.empty() ? "" : ", ") +
                 significant(longest * geometry::millimetres_per(unit), 4) + " mm if " +
                 name_of(unit);
    }
    throw InputError(object + ": the file doesn't carry its unit and its size, " +
                     sides(size, 1.0) + ", is ambiguous (longest side " + reading +
                     "). Give the unit by setting \"unit\": mm, cm, m or inch");
  }
  return {*proposed, UnitSource::kProposed,
          "the file carries no unit; taken as " + name_of(*proposed) +
              " because a product for the hand is then " +
              sides(size, geometry::millimetres_per(*proposed)) +
              " mm (setting \"unit\" overrides this)"};
}

}  // namespace palmar::product
