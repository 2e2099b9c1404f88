// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/imaging/distance_transform.h"
#include "hands/imaging/volume.h"

namespace palmar::capture {

/// Bright balls stuck on the skin.
struct SurfaceMarkers {
  std::vector<Vec3> centre;  ///< patient frame, mm
  imaging::VoxelMask mask;   ///< their voxels
};

/// Finds balls of a known diameter [mm] that stick out of the tissue: parts of the mask `tissue`
/// that an opening with a slightly larger ball takes off (nothing of a hand is that thin), as
/// bright as `least` [intensity] in their middle, with volume and spread of such a ball within a
/// factor of 1.6. Centres by least squares of the ball's blurred image,
///
///     I(x) = A P((D / 2 - |x - c|) / h),
///
/// P the normal distribution, h half a voxel, over the voxels that the opening left no tissue in.
SurfaceMarkers find_surface_markers(const imaging::Volume& image, const imaging::VoxelMask& tissue,
                                    double least, double diameter);

}  // namespace palmar::capture
