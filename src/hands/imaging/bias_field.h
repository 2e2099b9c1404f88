// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"

namespace palmar::imaging {

/// How a receive coil's uneven sensitivity is taken out of an MR image.
struct BiasFieldOptions {
  double shrunk_spacing = 2.0;  ///< mm between voxels of the image that the field is found on
  int levels = 3;               ///< of the B-spline; each doubles the number of its patches
  int iterations = 50;          ///< at most, per level
  double tolerance = 1e-3;      ///< change of the field, as a share of it, that ends a level
  double width = 0.15;  ///< full width at half maximum of the field's histogram, log intensity
  double noise = 0.01;  ///< Wiener filter's noise
  int bins = 200;       ///< of the histogram
  void check() const;   ///< throws UsageError: field, value, allowed range
};

/// Image v = u b with a smooth positive field b: finds b such that the histogram of log u is sharp,
/// and gives u. The field's mean logarithm over the mask is 0, so that intensities keep their
/// level.
///
/// `mask`: nonzero where there is tissue, one per voxel; empty: intensities above the threshold
/// that parts air from tissue (Otsu 1979). Voxels outside are divided by the field as well. Throws
/// UsageError, InputError for a mask of another size or without voxels, Cancelled.
///
/// Source: Tustison et al. 2010, "N4ITK: Improved N3 Bias Correction", IEEE Trans. Med. Imaging 29,
/// 1310-1320; Sled, Zijdenbos, Evans 1998 (sharpening); Lee, Wolberg, Shin 1997 (B-splines).
Volume corrected_for_bias(const Volume& image, const std::vector<std::uint8_t>& mask = {},
                          const BiasFieldOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::imaging
