// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/lens_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

PhotoLens true_lens() {
  return {.width = 1080,
          .height = 1440,
          .focal_x = 1795,
          .focal_y = 1805,
          .centre_x = 545,
          .centre_y = 712,
          .k1 = -0.08,
          .k2 = 0.05};
}

/// What the lens shows of the board, each coordinate off by `noise` (deviation, pixels).
std::vector<BoardCorner> seen(const PhotoCamera& camera, double noise, RandomStream& random) {
  const BoardPattern pattern;
  std::vector<BoardCorner> corners;
  for (int row = 1; row < pattern.squares; ++row) {
    for (int column = 1; column < pattern.squares; ++column) {
      const Vec3 world = pattern.corner(column, row);
      const auto pixel = camera.project(world);
      if (!pixel || pixel->x() < 5 || pixel->y() < 5 || pixel->x() > camera.lens.width - 6 ||
          pixel->y() > camera.lens.height - 6) {
        continue;
      }
      const Eigen::Vector2d error(noise * random.normal(), noise * random.normal());
      corners.push_back({static_cast<int>(corners.size()), world, *pixel + error});
    }
  }
  return corners;
}

PhotoCamera camera_at(double azimuth, double elevation, double far, double roll) {
  const double a = azimuth * geometry::kDegree, e = elevation * geometry::kDegree;
  const Vec3 centre = far * Vec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  return {true_lens(),
          geometry::Rigid3::about_axis(Vec3::UnitZ(), Vec3::Zero(), roll * geometry::kDegree) *
              looking_at(centre, Vec3(10, -15, 0))};
}

std::vector<std::vector<BoardCorner>> tilted_shots(double noise) {
  RandomStream random(5, 1);
  std::vector<std::vector<BoardCorner>> shots;
  for (int n = 0; n < 12; ++n) {
    shots.push_back(
        seen(camera_at(95.0 * n, 45.0 + 3.5 * n, 400.0 + 20.0 * (n % 5), 90.0 * (n % 2)), noise,
             random));
  }
  return shots;
}

TEST(CalibrateLens, WithoutNoiseTheLensIsFoundExactly) {
  const LensCalibration found = calibrate_lens(1080, 1440, tilted_shots(0.0), "test");
  const PhotoLens lens = true_lens();
  constexpr double kPull = 0.005;  // pixels; what lenses are like counts beside the photographs
  EXPECT_NEAR(found.lens.focal_x, lens.focal_x, kPull);
  EXPECT_NEAR(found.lens.focal_y, lens.focal_y, kPull);
  EXPECT_NEAR(found.lens.centre_x, lens.centre_x, kPull);
  EXPECT_NEAR(found.lens.centre_y, lens.centre_y, kPull);
  EXPECT_NEAR(found.lens.k1, lens.k1, 1e-5);
  EXPECT_NEAR(found.lens.k2, lens.k2, 1e-4);
  EXPECT_LT(found.rms, kPull);
}

TEST(CalibrateLens, WhatTheCameraSaysHoldsWhatPhotographsDoNotDetermine) {
  // Three photographs from one height hardly hold the focal length.
  RandomStream random(5, 4);
  std::vector<std::vector<BoardCorner>> shots;
  for (int n = 0; n < 3; ++n)
    shots.push_back(seen(camera_at(10.0 * n, 80.0, 500.0, 0.0), 0.3, random));
  const LensCalibration alone = calibrate_lens(1080, 1440, shots, "test");
  const LensCalibration with_expectation =
      calibrate_lens(1080, 1440, shots, "test", {.focal = 1800.0, .focal_deviation = 0.01});
  EXPECT_LT(with_expectation.focal_deviation, 0.5 * alone.focal_deviation);
  EXPECT_NEAR(with_expectation.lens.focal_x, 1795.0, 40.0);  // two deviations of what was stated
  EXPECT_NEAR(with_expectation.lens.centre_y, 712.0, 30.0);
}

TEST(CalibrateLens, ItsDeviationsAreThoseOfItsErrors) {
  const LensCalibration found = calibrate_lens(1080, 1440, tilted_shots(0.1), "test");
  EXPECT_NEAR(found.rms, 0.1, 0.01);  // pixels, less what the fit takes up
  EXPECT_LT(found.focal_deviation, 1.0);
  EXPECT_LT(std::abs(found.lens.focal_x - 1795.0), 4.0 * found.focal_deviation);
  EXPECT_LT(std::abs(found.lens.centre_y - 712.0), 4.0 * found.centre_deviation);
}

TEST(CalibrateLens, ACameraThatCirclesTheBoardKnowsItsCentreLess) {
  RandomStream random(5, 2);
  std::vector<std::vector<BoardCorner>> shots;
  for (int n = 0; n < 12; ++n)
    shots.push_back(seen(camera_at(30.0 * n, 45.0, 500.0, 0.0), 0.1, random));
  const LensCalibration circled = calibrate_lens(1080, 1440, shots, "test");
  const LensCalibration tilted = calibrate_lens(1080, 1440, tilted_shots(0.1), "test");
  EXPECT_GT(circled.centre_deviation, 3.0 * tilted.centre_deviation);
}

TEST(CalibrateLens, NamesWhatIsMissing) {
  auto shots = tilted_shots(0.0);
  for (std::size_t i = 2; i < shots.size(); ++i) shots[i].clear();
  try {
    calibrate_lens(1080, 1440, shots, "camera c4");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("camera c4"),
                                             testing::HasSubstr("2 of 12 photographs")));
  }
}

TEST(FindBoardPose, FindsTheCameraDespiteWrongCorners) {
  RandomStream random(5, 3);
  const PhotoCamera camera = camera_at(40.0, 25.0, 455.0, 0.0);
  std::vector<BoardCorner> corners = seen(camera, 0.05, random);
  ASSERT_GT(corners.size(), 30U);
  corners[3].pixel.x() += 15.0;
  corners[17].pixel.y() -= 6.0;
  const auto pose = find_board_pose(camera.lens, corners);
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->used, static_cast<int>(corners.size()) - 2);
  const PhotoCamera found{camera.lens, pose->camera_from_world};
  EXPECT_LT((found.centre() - camera.centre()).norm(), 0.5);  // mm
  corners.resize(7);
  EXPECT_FALSE(find_board_pose(camera.lens, corners).has_value());
}

}  // namespace
}  // namespace palmar::capture
