// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/photo_view.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {

Eigen::Vector3f pixel_colour(const geometry::RgbImage& image, const Eigen::Vector2d& pixel) {
  const double x = std::clamp(pixel.x(), 0.0, image.width - 1.0);
  const double y = std::clamp(pixel.y(), 0.0, image.height - 1.0);
  const int x0 = std::min(static_cast<int>(x), std::max(0, image.width - 2));
  const int y0 = std::min(static_cast<int>(y), std::max(0, image.height - 2));
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const std::uint8_t* const a = &image.rgb[pixel_offset(image, x0, y0)];
  const std::uint8_t* const b = &image.rgb[pixel_offset(image, x1, y0)];
  const std::uint8_t* const c = &image.rgb[pixel_offset(image, x0, y1)];
  const std::uint8_t* const d = &image.rgb[pixel_offset(image, x1, y1)];
  Eigen::Vector3f colour;
  for (int k = 0; k < 3; ++k) {
    const float top = a[k] + fx * static_cast<float>(b[k] - a[k]);
    const float bottom = c[k] + fx * static_cast<float>(d[k] - c[k]);
    colour[k] = top + fy * (bottom - top);
  }
  return colour;
}

PhotoView make_view(const Photograph& photograph, int reduction) {
  constexpr int kMost = 16;
  if (reduction < 1 || reduction > kMost) {
    throw UsageError("reduction " + std::to_string(reduction) + "; 1 to 16 is allowed");
  }
  const PhotoLens& lens = photograph.camera.lens;
  PhotoView view;
  view.camera = photograph.camera;
  PhotoLens& reduced = view.camera.lens;
  const double by = reduction;
  // The middle of the first reduced pixel is that of reduction x reduction pixels.
  const double shift = 0.5 * (by - 1.0);
  reduced = {.width = lens.width / reduction,
             .height = lens.height / reduction,
             .focal_x = lens.focal_x / by,
             .focal_y = lens.focal_y / by,
             .centre_x = (lens.centre_x - shift) / by,
             .centre_y = (lens.centre_y - shift) / by};
  view.colour.width = reduced.width;
  view.colour.height = reduced.height;
  const std::size_t count = static_cast<std::size_t>(reduced.width) * reduced.height;
  view.colour.rgb.resize(3 * count);
  view.grey.resize(count);
  const float share = 1.0F / static_cast<float>(reduction * reduction);
  parallel_for(reduced.height, [&](int y) {
    for (int x = 0; x < reduced.width; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int j = 0; j < reduction; ++j) {
        for (int i = 0; i < reduction; ++i) {
          const Eigen::Vector2d direction((x * by + i - lens.centre_x) / lens.focal_x,
                                          (y * by + j - lens.centre_y) / lens.focal_y);
          sum += pixel_colour(photograph.image, lens.pixel_of(direction));
        }
      }
      sum *= share;
      const std::size_t at = view.at(x, y);
      for (int k = 0; k < 3; ++k) {
        view.colour.rgb[3 * at + static_cast<std::size_t>(k)] =
            static_cast<std::uint8_t>(std::clamp(sum[k] + 0.5F, 0.0F, 255.0F));
      }
      view.grey[at] = sum.sum() / 3.0F;
    }
  });
  return view;
}

int reduction_for(const std::vector<Photograph>& photographs, const Vec3& point, double wanted) {
  std::vector<double> sizes;  // mm that a pixel covers
  for (const Photograph& photograph : photographs) {
    sizes.push_back((photograph.camera.camera_from_world * point).norm() /
                    photograph.camera.lens.focal_x);
  }
  if (sizes.empty()) return 1;
  constexpr double kMost = 16.0;
  return static_cast<int>(
      std::clamp(std::round(wanted / statistics::median(std::move(sizes))), 1.0, kMost));
}

}  // namespace palmar::capture
