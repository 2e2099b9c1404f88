// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/parts/solid_grid.h"

namespace palmar::product {

/// A ball of the solid, in the grid's frame, mm.
struct SolidBall {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  int part = 0;
};

/// Part of the ball that a point is nearest to (distance to its surface).
int nearest_part(const std::vector<SolidBall>& balls, const Vec3& point);

/// What of the solid is nearest to the balls of a part, between parallel planes.
struct PartRegion {
  double count = 0.0;             ///< voxels
  double deepest = 0.0;           ///< largest depth, mm
  std::vector<double> low, high;  ///< along the hull's directions, mm
};

PartRegion united(const PartRegion& a, const PartRegion& b);

/// The regions of all parts and what their hulls are measured with.
struct PartRegions {
  int stride = 1;                ///< voxels: every second one per axis of a large grid
  std::vector<Vec3> directions;  ///< unit, of the hulls' planes
  std::vector<PartRegion> region;
  std::map<std::pair<int, int>, double> border;  ///< between two of them, a < b; mm^2
};

PartRegions part_regions(const SolidGrid& grid, const std::vector<SolidBall>& balls, int parts);

/// How far the hull of a region (one of `regions` or a union of them) reaches beyond the solid, mm;
/// stops when it is more than `limit`.
double hollowness(const SolidGrid& grid, const PartRegions& regions, const PartRegion& region,
                  double limit);

}  // namespace palmar::product
