// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"

namespace palmar::imaging {

struct DenoiseOptions {
  int iterations = 5;
  /// Gradient across which little flows, as a multiple of the noise's deviation found in the image.
  double edge = 3.0;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Deviation of the noise, in intensities: from the median absolute Laplacian-like difference,
/// which smooth tissue and edges hardly touch (Immerkaer 1996; median after Donoho 1994).
double noise_deviation(const Volume& image);

/// Smooths within tissues and keeps their borders: nonlinear diffusion in three dimensions,
/// explicit steps, with distances in mm so that coarse slices mix less.
///
///     dI/dt = div(c(|grad I|) grad I),   c(s) = exp(-(s / K)^2),   K = edge x noise
///
/// Source: Perona, Malik 1990, eq. (3), (7); IEEE Trans. Pattern Anal. 12, 629-639.
/// Throws UsageError, Cancelled.
Volume denoised(const Volume& image, const DenoiseOptions& options = {},
                const Progress& progress = {});

}  // namespace palmar::imaging
