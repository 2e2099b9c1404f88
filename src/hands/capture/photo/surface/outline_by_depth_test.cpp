// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/outline_by_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palmar::capture {
namespace {

/// A camera 500 mm to the side of a ball in the middle of its picture; 1 mm per pixel there.
PhotoView side_view() {
  PhotoView view;
  view.camera.lens = {.width = 300,
                      .height = 300,
                      .focal_x = 500.0,
                      .focal_y = 500.0,
                      .centre_x = 149.5,
                      .centre_y = 149.5};
  view.camera.camera_from_world = looking_at(Vec3(500, 0, 100), Vec3(0, 0, 100));
  view.colour = {300, 300, std::vector<std::uint8_t>(300 * 300 * 3, 128)};
  view.grey.assign(300 * 300, 128.0F);
  return view;
}

std::vector<SurfacePoint> ball(const Vec3& centre, double radius, int count) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const Vec3 n(r * std::cos(turn), r * std::sin(turn), z);
    points.push_back({(centre + radius * n).cast<float>(), n.cast<float>(), 3});
  }
  return points;
}

TEST(NarrowToPoints, KeepsTheOutlineOfTheLargestGroup) {
  std::vector<SurfacePoint> points = ball(Vec3(0, 0, 100), 40.0, 40000);
  const std::vector<SurfacePoint> other = ball(Vec3(0, 90, 100), 10.0, 4000);
  points.insert(points.end(), other.begin(), other.end());
  const std::vector<PhotoView> views = {side_view()};
  std::vector<PhotoMask> masks = {{std::vector<std::uint8_t>(300 * 300, 1), 1.0, 1.0}};
  ASSERT_TRUE(narrow_to_points(points, views, 6.0, masks));
  // A ball of 40 mm, 500 mm away: its outline is a circle of 500 tan(asin(40/500)) pixels.
  const double outline = 500.0 * std::tan(std::asin(40.0 / 500.0));
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const double off = std::hypot(x - 149.5, y - 149.5);
      const bool is_in = masks[0].inside[views[0].at(x, y)] != 0;
      EXPECT_TRUE(is_in || off >= outline) << x << " " << y;
      EXPECT_TRUE(!is_in || off <= outline + 6.0 + 3.0 + 1.0) << x << " " << y;
    }
  }
}

TEST(NarrowToPoints, HardlyAnythingIsNoHand) {
  const std::vector<PhotoView> views = {side_view()};
  std::vector<PhotoMask> masks = {{std::vector<std::uint8_t>(300 * 300, 1), 1.0, 1.0}};
  EXPECT_FALSE(narrow_to_points({}, views, 6.0, masks));
  EXPECT_FALSE(narrow_to_points(ball(Vec3(0, 0, 100), 15.0, 4000), views, 6.0, masks));
}

}  // namespace
}  // namespace palmar::capture
