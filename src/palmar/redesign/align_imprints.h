// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/redesign/imprint.h"

namespace palmar::redesign {

/// How far each hand would have to move along `axis` (unit, product frame) for its imprint to lie
/// best on those of all: hands of different size touch at different places, so that the concaves of
/// their fingers smear over each other.
///
/// Per hand the profile f(x), depth times area per mm along the axis; its shift s maximises the
/// correlation of f(x - s) with the mean profile of all shifted hands, |s| <= limit; repeated until
/// no shift changes by more than a step of 0.25 mm. The shifts' mean is 0: the shape stays where
/// the hands hold. It is sound where the product is the same along the axis, or nearly so, and it
/// is a statement: people will take it where the concaves are. Independent of the order of hands.
///
/// `points`, `areas`: per surface point, mm and mm^2. A hand without imprint gets 0.
std::vector<double> align_imprints(std::span<const Imprint> imprints, std::span<const Vec3> points,
                                   std::span<const double> areas, const Vec3& axis, double limit);

}  // namespace palmar::redesign
