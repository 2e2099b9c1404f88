// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// A slice that doesn't belong between its neighbours.
struct OddSlice {
  int index = 0;       ///< along k
  double ratio = 0.0;  ///< how many times farther from both than they are from each other
};

/// Slices along k that differ from both neighbours far more than these from each other:
/// overwritten, half empty, of another image. Per slice q = min(|s - s-|, |s - s+|) / |s+ - s-|
/// (root mean square); noise alone gives 1, what changes from slice to slice less. Odd is q above
/// twice the median of all and above 1.5, so a scanner that makes every other slice brighter isn't.
/// The two outermost slices can't be determined.
std::vector<OddSlice> odd_slices(const Volume& image);

}  // namespace palmar::imaging
