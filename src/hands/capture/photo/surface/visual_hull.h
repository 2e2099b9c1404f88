// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/photo/photo_mask.h"
#include "hands/imaging/volume.h"

namespace palmar::capture {

struct VisualHullOptions {
  double spacing = 1.5;       ///< mm between voxels
  int missing = 1;            ///< masks that may leave a voxel out, since masks have faults
  double least_views = 0.25;  ///< share of the views that must see a voxel
  void check() const;         ///< throws UsageError: field, value, allowed range
};

/// The largest thing that casts the outlines: it holds the hand, and is a bound for it, not its
/// shape (a hollow that no outline shows is filled).
struct VisualHull {
  imaging::Volume occupancy;       ///< 0 to 1, smoothed by a voxel
  geometry::TriangleMesh surface;  ///< where the occupancy is 1/2; closed
};

/// Of voxels in the box those that no more than `missing` of the views that see them leave out; the
/// largest connected part. Throws InputError if nothing is left: masks and cameras don't belong
/// together.
/// Source: Laurentini 1994, "The visual hull concept for silhouette-based image understanding".
VisualHull make_visual_hull(const std::vector<PhotoView>& views,
                            const std::vector<PhotoMask>& masks, const Box3& box,
                            const VisualHullOptions& options = {});

}  // namespace palmar::capture
