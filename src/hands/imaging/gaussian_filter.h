// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// The image blurred by a Gaussian of standard deviation `sigma` [mm] along each axis, whatever the
/// spacing; cut off at 3 sigma; at the border the weights of what is there count alone. 0 changes
/// nothing. The same for any number of threads. Throws UsageError if sigma is negative or not
/// finite.
Volume gaussian_filtered(const Volume& image, double sigma);

}  // namespace palmar::imaging
