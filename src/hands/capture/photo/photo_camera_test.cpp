// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/photo_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

PhotoLens make_lens() {
  return {.width = 1000,
          .height = 800,
          .focal_x = 1200,
          .focal_y = 1100,
          .centre_x = 490,
          .centre_y = 410,
          .k1 = -0.1,
          .k2 = 0.05};
}

TEST(PhotoLens, BendsDirectionsAsItsEquationSays) {
  // r^2 = 0.25: d = 1 - 0.025 + 0.003125 = 0.978125
  const Eigen::Vector2d pixel = make_lens().pixel_of({0.3, -0.4});
  EXPECT_NEAR(pixel.x(), 1200 * 0.978125 * 0.3 + 490, 1e-9);
  EXPECT_NEAR(pixel.y(), -1100 * 0.978125 * 0.4 + 410, 1e-9);
}

TEST(PhotoLens, GivesBackEveryDirection) {
  const PhotoLens lens = make_lens();
  for (double x = -0.45; x <= 0.45; x += 0.09) {
    for (double y = -0.4; y <= 0.4; y += 0.08) {
      const Eigen::Vector2d back = lens.direction_of(lens.pixel_of({x, y}));
      EXPECT_NEAR((back - Eigen::Vector2d(x, y)).norm(), 0.0, 1e-12);
    }
  }
}

TEST(PhotoCamera, LooksAtItsTargetWithTheBoardLevel) {
  PhotoCamera camera;
  camera.lens = make_lens();
  camera.lens.k1 = camera.lens.k2 = 0.0;
  camera.camera_from_world = looking_at(Vec3(0, -300, 400), Vec3::Zero());
  EXPECT_NEAR((camera.centre() - Vec3(0, -300, 400)).norm(), 0.0, 1e-9);
  // The target in the middle; 50 mm to the right on the board 500 mm away: 1200 * 50 / 500 pixels.
  EXPECT_NEAR((*camera.project(Vec3::Zero()) - Eigen::Vector2d(490, 410)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((*camera.project(Vec3(50, 0, 0)) - Eigen::Vector2d(610, 410)).norm(), 0.0, 1e-9);
  // What is higher is higher in the picture: a smaller y.
  EXPECT_LT(camera.project(Vec3(0, 0, 50))->y(), 410.0);
  EXPECT_FALSE(camera.project(Vec3(0, -600, 800)).has_value());
  // The ray through a point's pixel meets the point.
  const Vec3 point(30, 20, 10);
  EXPECT_NEAR((point - camera.centre()).normalized().dot(camera.ray(*camera.project(point))), 1.0,
              1e-12);
}

TEST(PhotoLens, NamesWhatIsWrong) {
  PhotoLens lens = make_lens();
  lens.focal_x = 12.0;
  try {
    lens.check("cameras.json: camera 3");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("cameras.json: camera 3"),
                                             testing::HasSubstr("focal length is 12")));
  }
}

}  // namespace
}  // namespace palmar::capture
