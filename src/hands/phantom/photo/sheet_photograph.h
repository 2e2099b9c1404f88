// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/phantom/person/spread_hand.h"
#include "hands/phantom/photo/photographs.h"

namespace palmar::phantom {

/// A hand flat on a sheet of paper, or on a table beside a bank card, and a photographer above it.
struct SheetPhotographOptions {
  std::uint64_t seed = 1;                ///< place, turn and noise
  double width = 210.0, height = 297.0;  ///< of the sheet or card, mm
  /// A card: the hand lies on the table, the card beside it on the little finger's side, its lower
  /// edge level with the crease of the wrist.
  bool is_card = false;
  double corner = 0.0;      ///< radius of its corners, mm
  double thickness = 0.0;   ///< its face lies that much above the table, mm
  double tilt = 6.0;        ///< of the camera from the sheet's normal, deg, anywhere about
  double distance = 420.0;  ///< of the camera from the table below the middle of the picture, mm
  int pixels_wide = 1512, pixels_high = 2016;
  double focal = 0.74;                        ///< of the longer side
  double k1 = 0.0;                            ///< of the lens' distortion, see PhotoLens
  geometry::Srgb table{0.42F, 0.28F, 0.18F};  ///< its grain is up to 30 % darker and brighter
  bool is_plain = false;                      ///< the table has no grain
  geometry::Srgb skin{0.80F, 0.60F, 0.50F};
  geometry::Srgb card{0.12F, 0.42F, 0.30F};  ///< its face, with dark print
  double wrist_inside = 0.0;  ///< wrist crease inside of the sheet's or card's edge, mm
  void check() const;         ///< throws UsageError: field, value, allowed range
};

/// The hand palm down, the fingers' pads on the paper, the middle of its wrist crease over the
/// sheet's lower edge or level with the card's. Frame of the sheet or card: its middle the origin,
/// y up, z towards the camera, the table or paper at 0.
geometry::TriangleMesh hand_on_sheet(const SpreadHand& hand, const SheetPhotographOptions& options);

/// The photograph of it.
geometry::RgbImage photograph_on_sheet(const SpreadHand& hand,
                                       const SheetPhotographOptions& options);

}  // namespace palmar::phantom
