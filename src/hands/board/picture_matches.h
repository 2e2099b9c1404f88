// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "palmar/core/progress.h"

namespace palmar::board {

/// A grey picture and where in it points may be found.
struct MaskedPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey, inside;  ///< row by row; inside: 0 or 1
};

/// Points of pictures that look distinct, and which of them look alike.
struct PictureMatches {
  std::vector<std::vector<std::array<float, 2>>> point;  ///< per picture: pixels
  struct Pair {
    int first = 0, second = 0;              ///< pictures
    std::vector<std::array<int, 2>> match;  ///< their points
  };
  std::vector<Pair> pairs;
};

/// SIFT points (Lowe 2004) by OpenCV; a match is the nearest descriptor in both directions, nearer
/// than `ratio` of the second nearest.
PictureMatches match_pictures(const std::vector<MaskedPicture>& pictures,
                              const std::vector<std::array<int, 2>>& pairs, double ratio = 0.85,
                              int most_points = 3000, const Progress& progress = {});

}  // namespace palmar::board
