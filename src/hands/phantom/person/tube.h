// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::phantom {

/// Closed tube of round section along a smooth curve (Catmull-Rom) through at least two points,
/// tapered at both ends; mm.
geometry::TriangleMesh tube_mesh(const std::vector<Vec3>& through, double radius);

}  // namespace palmar::phantom
