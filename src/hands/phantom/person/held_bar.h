// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::phantom {

/// A round bar in a closed hand; hand frame, mm.
struct HeldBar {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitX();
  double radius = 15.0;
  double distance(const Vec3& p) const;  ///< of a point from the axis
};

/// Skin that stands in the bar lies flat on it.
void flatten_on(const HeldBar& bar, std::vector<Vec3>& skin);

/// Closed, 140 mm long.
geometry::TriangleMesh bar_mesh(const HeldBar& bar);

}  // namespace palmar::phantom
