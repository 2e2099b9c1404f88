// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/capture/photo/photo_view.h"

namespace palmar::capture {

struct PhotoMaskOptions {
  /// Chromaticities (red and blue over the sum of the three channels) so near to those of the
  /// board's white are paper, print or shadow, not skin.
  double neutral = 0.028;
  double blue = 0.05;  ///< blue over red by this much in chromaticity: backdrop
  double dark = 0.10;  ///< of white; darker pixels have no colour that could be determined
  double close = 1.5;  ///< gaps of the mask this wide are closed (paint on the outline), mm
  double fill = 40.0;  ///< holes of the mask up to this area are filled, mm^2
  double grow = 1.0;   ///< the mask is grown by this much, mm: missing hand can't be compensated
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Where the hand may be in a view; rather too much than too little.
struct PhotoMask {
  std::vector<std::uint8_t> inside;  ///< per pixel of the view: 0 or 1
  double box_share = 0.0;            ///< of the box' pixels that are inside
  double pixel_size = 0.0;           ///< mm at the middle of the box
  Eigen::Vector3f paper = Eigen::Vector3f::Constant(255.0F);  ///< of the board, 0 to 255
  /// Of the pixels beside box and board those that look like a hand, where there is none: a
  /// background that colours don't distinguish from one. 1 if they are less than 5 % of the
  /// picture.
  double around_share = 1.0;
};

/// Pixels of the box' outline in the picture that are neither neutral (by the white of the board,
/// whose half edge is `board_half` mm) nor blue.
PhotoMask mask_hand(const PhotoView& view, const Box3& box, double board_half,
                    const PhotoMaskOptions& options = {});

}  // namespace palmar::capture
