// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

/// How much of every pixel a shape covers: the exact area of polygons within the pixel, summed
/// along rows from the signed areas that the edges cut off. Shapes placed over one another must
/// turn the same way; what they share counts once where they cover it wholly.
class CoverageMask {
 public:
  CoverageMask(int image_width, int image_height);
  /// Adds a closed polygon; points in pixels, y down. Clipped to the picture.
  void add_polygon(std::span<const Eigen::Vector2d> points);
  /// Adds a line of a width with round joins, and round ends if wanted.
  void add_line(std::span<const Eigen::Vector2d> points, double width, bool has_round_ends);
  /// Places the colour over the picture and empties the mask.
  void paint(Image& image, Rgb colour, double opacity);

 private:
  void add_edge(Eigen::Vector2d a, Eigen::Vector2d b);
  void add_slope(int row, double x0, double x1, double height);

  int width_, height_;
  int first_row_, last_row_;   // touched since the last paint()
  std::vector<double> cover_;  // height x (width + 1): change of coverage from pixel to pixel
};

}  // namespace palmar::report
