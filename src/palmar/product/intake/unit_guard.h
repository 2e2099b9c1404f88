// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/geometry/types.h"
#include "palmar/product/product.h"

namespace palmar::product {

/// The unit of a mesh and why.
struct UnitDecision {
  geometry::LengthUnit unit = geometry::LengthUnit::kMillimetre;
  UnitSource source = UnitSource::kMade;
  std::string explanation;  ///< one sentence for people; empty if there is nothing to report
};

/// Settles the unit of a mesh; never silently. `box` is its bounding box in file units, `object`
/// names it in messages.
///
/// What the user says wins over what the file says (a contradiction is reported). If neither is
/// known, the size is held against a hand: the longest side of a handheld product is 40 to 600 mm.
/// A unit is proposed only if it is the only one that fits, or the fit of another would be odd:
///
///     longest side in the file   proposed      because
///     0.04 to 0.6                m             in any other unit it is below 16 mm
///     1.6 to 4                   inch          40 to 102 mm; in cm below 40 mm, in m above 1.6 m
///     4 to 24                    undecidable   cm and inch both fit
///     24 to 40                   undecidable   24 to 40 mm and 24 to 40 cm are both odd
///     40 to 2000                 mm            up to 60 also fits cm, but files in mm are the
///     rule;
///                                              above 600 it is long in mm and absurd in the others
///     anything else              undecidable
///
/// Throws InputError (exit code 3) naming the size and --unit if undecidable; and naming the size
/// if it is not finite, zero, or outside 0.1 mm to 10 m in the unit that was given.
UnitDecision decide_unit(const Box3& box, std::optional<geometry::LengthUnit> from_file,
                         std::optional<geometry::LengthUnit> from_user, const std::string& object);

}  // namespace palmar::product
