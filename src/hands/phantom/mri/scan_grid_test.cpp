// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/mri/scan_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::phantom {
namespace {

using ::testing::HasSubstr;

/// Corners of a hand of 90 x 40 x 240 mm with fingertips at z = 100.
std::vector<Vec3> hand_box() {
  std::vector<Vec3> corners;
  for (const double x : {-40.0, 50.0}) {
    for (const double y : {-30.0, 10.0}) {
      for (const double z : {-140.0, 100.0}) corners.emplace_back(x, y, z);
    }
  }
  return corners;
}

TEST(ScanGrid, HandLiesInTheMiddleWithItsFingertipsAtTheTop) {
  const imaging::VolumeGrid grid = scan_grid(hand_box());
  EXPECT_EQ(grid.size, (std::array<int, 3>{256, 256, 124}));              // 200 mm / 0.78 mm
  EXPECT_LT((grid.axes * Vec3(1, 2, 3) - Vec3(1, 3, -2)).norm(), 1e-12);  // left, back, feet
  const Vec3 top = grid.to_patient(Vec3(127.5, 0.0, 61.5));
  EXPECT_LT((top - Vec3(5.0, -10.0, 106.0)).norm(), 1e-9);
  EXPECT_NEAR(grid.axes.determinant(), 1.0, 1e-12);
}

TEST(ScanGrid, TheForearmsEndIsNeverSeen) {
  ScanGridOptions options;
  options.field = 400.0;
  const imaging::VolumeGrid straight = scan_grid(hand_box(), options);
  EXPECT_GT(straight.to_patient(Vec3(0, straight.size[1] - 1, 0)).z(), -140.0 + 6.0 - 0.78);
  options.oblique = 0.35;
  const imaging::VolumeGrid tilted = scan_grid(hand_box(), options);
  for (const Vec3& corner : hand_box()) {
    if (corner.z() >= 0.0) continue;
    EXPECT_GT(tilted.to_voxel(corner)[1], tilted.size[1] - 1.0);
  }
  for (int a = 0; a < 3; ++a) {  // no axis is left where it was
    EXPECT_LT(tilted.axes.col(a).cwiseAbs().maxCoeff(), 0.999);
  }
}

TEST(ScanGrid, OffsetShiftsAlongTheImagesAxes) {
  ScanGridOptions options;
  const Vec3 middle = scan_grid(hand_box(), options).origin;
  options.offset = Vec3(10, 20, -5);
  EXPECT_LT((scan_grid(hand_box(), options).origin - middle - Vec3(10, -5, -20)).norm(), 1e-9);
}

TEST(ScanGrid, OptionsAreChecked) {
  const auto message = [](const ScanGridOptions& options) {
    try {
      options.check();
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  ScanGridOptions options;
  options.pixel = 0.0;
  EXPECT_THAT(message(options), HasSubstr("pixel is 0 mm; 0.1 to 5 are allowed"));
  options = {};
  options.pixel = 0.1;
  options.field = 500.0;
  EXPECT_THAT(message(options), HasSubstr("3100 million voxels; up to 500 million are allowed"));
}

}  // namespace
}  // namespace palmar::phantom
