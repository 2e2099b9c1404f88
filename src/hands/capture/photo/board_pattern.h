// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::capture {

/// A chessboard with a marker in every white square, by which its inner corners are distinguished.
/// Its middle is the origin of the world; x along the rows of the print, y up its columns, z
/// towards the reader. Source: Garrido-Jurado et al. 2014 (markers); their chessboard of corners as
/// OpenCV has it, with markers of 5 x 5 cells, 250 of them. An odd number of squares: versions of
/// OpenCV agree about those.
struct BoardPattern {
  int squares = 11;      ///< along an edge; odd, 5 to 21
  double square = 36.0;  ///< edge of a square, mm
  double marker = 27.0;  ///< edge of a marker, mm
  void check() const;    ///< throws UsageError: field, value, allowed range

  double edge() const { return squares * square; }
  int corner_count() const { return (squares - 1) * (squares - 1); }
  /// Corner in `column` and `row` of the print, from 1 at the upper left one to squares - 1.
  Vec3 corner(int column, int row) const {
    return {column * square - 0.5 * edge(), 0.5 * edge() - row * square, 0.0};
  }
};

/// A corner of the board as a photograph shows it.
struct BoardCorner {
  int id = 0;                                       ///< which
  Vec3 world = Vec3::Zero();                        ///< mm
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< whole numbers: centres of pixels
};

/// The pattern as a picture, as it is to be printed.
struct BoardPicture {
  int pixels = 0;  ///< along an edge; a multiple of the squares
  std::vector<std::uint8_t> grey;
};

}  // namespace palmar::capture
