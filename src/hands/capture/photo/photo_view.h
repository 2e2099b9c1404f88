// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/photo/photo_camera.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::capture {

/// Where a pixel's three bytes begin.
inline std::size_t pixel_offset(const geometry::RgbImage& image, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * image.width + x);
}

/// Colour between pixels, bilinear, 0 to 255; beyond the border that of the border.
Eigen::Vector3f pixel_colour(const geometry::RgbImage& image, const Eigen::Vector2d& pixel);

/// One photograph of a set, its camera known.
struct Photograph {
  std::string name;
  geometry::RgbImage image;
  PhotoCamera camera;
  /// Photographs of one position of the rig were taken together: the hand did not move between.
  int position = 0;
};

/// A photograph without distortion, reduced: what masks and stereo work on. Its lens has k1 = k2 =
/// 0.
struct PhotoView {
  PhotoCamera camera;
  geometry::RgbImage colour;
  std::vector<float> grey;  ///< mean of the three channels, 0 to 255, per pixel
  int width() const { return colour.width; }
  int height() const { return colour.height; }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * colour.width + x; }
};

/// Every pixel of the view is the mean of reduction x reduction samples of the photograph. Throws
/// UsageError unless 1 <= reduction <= 16.
PhotoView make_view(const Photograph& photograph, int reduction);

/// How many times photographs are reduced, so that a pixel covers about `wanted` mm at `point`:
/// at least 1.
int reduction_for(const std::vector<Photograph>& photographs, const Vec3& point, double wanted);

}  // namespace palmar::capture
