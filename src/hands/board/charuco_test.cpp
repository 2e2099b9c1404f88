// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/board/charuco.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"

namespace palmar::board {
namespace {

/// The board seen by a camera without distortion from straight above: `scale` pixels per mm, its
/// middle on `middle`; each pixel the mean of 10 x 10 points.
std::vector<std::uint8_t> seen_from_above(const capture::BoardPicture& board, double edge,
                                          double scale, const Eigen::Vector2d& middle, int size) {
  std::vector<std::uint8_t> image;
  constexpr int kPoints = 10;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      double sum = 0.0;
      for (int s = 0; s < kPoints * kPoints; ++s) {
        const double u = x + (s % kPoints + 0.5) / kPoints - 0.5 - middle.x();
        const double v = y + (static_cast<double>(s / kPoints) + 0.5) / kPoints - 0.5 - middle.y();
        const auto i = static_cast<int>(std::floor((u / scale / edge + 0.5) * board.pixels));
        const auto j = static_cast<int>(std::floor((v / scale / edge + 0.5) * board.pixels));
        const bool is_on = i >= 0 && j >= 0 && i < board.pixels && j < board.pixels;
        sum += is_on ? board.grey[static_cast<std::size_t>(j) * board.pixels + i] : 255.0;
      }
      image.push_back(static_cast<std::uint8_t>(sum / (kPoints * kPoints)));
    }
  }
  return image;
}

TEST(CharucoFinder, FindsCornersWhereTheyAreDrawn) {
  const capture::BoardPattern pattern;
  const CharucoFinder finder(pattern);
  const Eigen::Vector2d middle(300.3, 297.6);
  constexpr double kScale = 1.4;
  const auto corners =
      finder.find(seen_from_above(finder.draw(60), pattern.edge(), kScale, middle, 600), 600, 600);
  ASSERT_GT(corners.size(), 90U);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const capture::BoardCorner& corner : corners) {
    const Eigen::Vector2d expected =
        middle + kScale * Eigen::Vector2d(corner.world.x(), -corner.world.y());
    EXPECT_NEAR((corner.pixel - expected).norm(), 0.0, 0.2);  // pixels
    sum += corner.pixel - expected;
  }
  // Half a pixel of OpenCV 4.6 would show here.
  EXPECT_NEAR((sum / static_cast<double>(corners.size())).norm(), 0.0, 0.05);
}

TEST(CharucoFinder, FindsNothingWhereThereIsNoBoard) {
  const CharucoFinder finder(capture::BoardPattern{});
  EXPECT_TRUE(finder.find(std::vector<std::uint8_t>(200 * 150, 128), 200, 150).empty());
}

TEST(CharucoFinder, RefusesAnEvenBoard) {
  capture::BoardPattern pattern;
  pattern.squares = 10;
  EXPECT_THROW(CharucoFinder{pattern}, UsageError);
}

}  // namespace
}  // namespace palmar::board
