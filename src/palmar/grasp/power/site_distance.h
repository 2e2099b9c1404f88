// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/types.h"
#include "palmar/grasp/power/grip_axis.h"

namespace palmar::grasp {

/// Quick distance to the part of a product round a grip site, for a search that asks a million
/// times. Answers within kSiteBand of the surface; farther points come back as +-range. A grid in
/// the site's own axes (not the file's), so that a turned product gives the same numbers. Points
/// farther than a hand from the site count as outside.
inline constexpr double kSiteBand = 10.0;  // mm
std::unique_ptr<geometry::DistanceField> distance_near(
    const geometry::TriangleMesh& mesh, std::shared_ptr<const geometry::DistanceField> product,
    const GripSite& site);

/// The exact distance wherever `quick` says that a point is less than `margin` [mm] outside or
/// inside the product; elsewhere the quick one. Both must live longer.
std::unique_ptr<geometry::DistanceField> exact_where_touched(const geometry::DistanceField& quick,
                                                             const geometry::DistanceField& exact,
                                                             double margin);

/// Thickness of the solid under the surface that a hand takes at a site, mm: twice the depth
/// that 65 % of the area doesn't exceed when going straight in, at most 2 * kSiteBand. For a
/// mug that is its wall.
double wall_at(const geometry::TriangleMesh& mesh, const geometry::DistanceField& distance,
               const GripSite& site, double palm_breadth);

}  // namespace palmar::grasp
