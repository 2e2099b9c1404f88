// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// Standard deviation of an image's noise, from the tissue itself: where scanners mask the air, its
/// noise is gone. A voxel less the mean of its two neighbours along an axis has no signal where
/// that is linear, and noise of sqrt(3 / 2) times the deviation; the median of its absolute value
/// over the voxels that lie deeper than `deeper` (mm, `depth` as of distance_transform) leaves out
/// the edges. Of the three axes the least: texture and edges only add. 0 where nothing lies so
/// deep. Source: Immerkaer 1996, "Fast noise variance estimation", with the median of Donoho 1995.
double tissue_noise(const Volume& image, const std::vector<float>& depth, double deeper);

}  // namespace palmar::imaging
