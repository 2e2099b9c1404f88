// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// Intensity that parts the image's histogram in two classes of least variance: air from tissue in
/// an MR image of a hand. The value itself counts as air. 0 for an empty image, its value for one
/// that is the same everywhere.
///
/// Source: Otsu 1979, "A threshold selection method from gray-level histograms", eq. (12), (18).
double air_threshold(const Volume& image);

}  // namespace palmar::imaging
