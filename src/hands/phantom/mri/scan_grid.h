// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/volume.h"

namespace palmar::phantom {

/// How an operator places the slices through a hand.
struct ScanGridOptions {
  double pixel = 0.78;  ///< mm, along both edges of a slice (Xie 2014, section 2.2.1)
  double slice = 1.0;   ///< mm from slice to slice
  int slices = 124;
  double field = 200.0;         ///< mm, largest edge of a slice
  double oblique = 0.0;         ///< rad; turns the slices out of the coronal plane
  Vec3 offset = Vec3::Zero();   ///< mm along i, j, k: the hand isn't in the middle
  double forearm_margin = 6.0;  ///< mm of the forearm's end that must not be seen
  void check() const;           ///< throws UsageError: field, value, allowed range
};

/// Coronal slices through a hand with fingers towards the patient's head (+z): i to the patient's
/// left, j to the feet, k to the back. `skin`: the hand's vertices, patient frame. Fingertips lie 6
/// mm below the upper edge; the lower edge cuts the forearm; in the other two directions the hand
/// is in the middle.
imaging::VolumeGrid scan_grid(const std::vector<Vec3>& skin, const ScanGridOptions& options = {});

}  // namespace palmar::phantom
