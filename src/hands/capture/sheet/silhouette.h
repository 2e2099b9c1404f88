// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/capture/sheet/sheet_grid.h"
#include "hands/imaging/distance_transform.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Cells of a sheet that a body hides from a camera: whose centre lies in a triangle's shadow, with
/// the lamp in the place of the camera. A point p above the sheet hides
///
///     s = e + (p - e) e_z / (e_z - p_z)   (x and y; e the camera's centre),
///
/// all in the sheet's frame, mm. Triangles that reach up to the camera hide nothing.
imaging::VoxelMask silhouette(const geometry::TriangleMesh& body, const Vec3& eye,
                              const SheetGrid& grid);

}  // namespace palmar::capture
