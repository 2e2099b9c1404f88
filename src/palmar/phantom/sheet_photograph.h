// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/hand.h"
#include "palmar/phantom/photographs.h"

namespace palmar {

/// A hand flat on a sheet of paper and a photographer above it.
struct SheetPhotographOptions {
  std::uint64_t seed = 1;                ///< posture, place, turn and noise
  double width = 210.0, height = 297.0;  ///< of the sheet, mm
  double tilt = 6.0;        ///< of the camera from the sheet's normal, deg, anywhere about
  double distance = 420.0;  ///< of the camera from the sheet's middle, mm
  int pixels_wide = 1512, pixels_high = 2016;
  double focal = 0.74;              ///< of the longer side
  Srgb table{0.42F, 0.28F, 0.18F};  ///< its grain is up to 30 % darker and brighter
  Srgb skin{0.80F, 0.60F, 0.50F};
  double together = 0.0;      ///< 0: fingers spread as told; 1: side by side
  double wrist_inside = 0.0;  ///< wrist crease inside of the sheet's edge, mm
  void check() const;         ///< throws UsageError: field, value, allowed range
};

/// The hand spread, palm down, the fingers' pads on the paper, the crease of its wrist over the
/// sheet's lower edge. In the sheet's frame: middle the origin, y up, z towards the camera.
TriangleMesh hand_on_sheet(const Hand& hand, const SheetPhotographOptions& options);

/// The photograph of it.
RgbImage photograph_on_sheet(const Hand& hand, const SheetPhotographOptions& options);

}  // namespace palmar
