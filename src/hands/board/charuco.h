// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "hands/capture/photo/board_pattern.h"

namespace palmar::board {

/// Draws a board and finds its corners in pictures, by OpenCV.
///
/// OpenCV 4.6 finds corners half a pixel too far to the right and down (its issue 25539), later
/// versions don't. So a drawn board, whose corners are known, is searched first: what is found
/// there too far is taken off everywhere, and says where OpenCV puts which corner. Corners are
/// then found again as saddle points of the brightness in windows without markers.
class CharucoFinder {
 public:
  /// Throws UsageError as BoardPattern::check(), NumericalError if the drawn board isn't found.
  explicit CharucoFinder(const capture::BoardPattern& pattern);
  ~CharucoFinder();

  /// The pattern with `pixels_per_square` pixels along a square.
  capture::BoardPicture draw(int pixels_per_square) const;
  /// Corners in a grey picture, row by row; ascending ids. Empty if there is no board.
  std::vector<capture::BoardCorner> find(const std::vector<std::uint8_t>& grey, int width,
                                         int height) const;
  /// What is taken off, pixels.
  const Eigen::Vector2d& offset() const { return offset_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();
  std::vector<Vec3> world_;  ///< per id
};

}  // namespace palmar::board
