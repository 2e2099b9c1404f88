// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::report {

/// Unit normal at each corner of each triangle for smooth shading: the mean of the normals of the
/// triangles that meet there, weighted by their angles, leaving out those that turn away by more
/// than `crease_angle` [rad], so that edges stay sharp. Vertices at the same place count as one.
/// Collapsed triangles get +z.
std::vector<std::array<Vec3, 3>> shading_normals(const geometry::TriangleMesh& mesh,
                                                 double crease_angle);

}  // namespace palmar::report
