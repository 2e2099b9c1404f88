// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_regions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palmar::capture {
namespace {

// Signals of T1-weighted images: cortical bone 20, muscle 90, marrow and fat 200.
constexpr double kDark = 20.0, kMuscle = 90.0, kBright = 200.0;

/// A cylinder of marrow, 5 mm wide and 14 mm long as in a distal phalanx, in a rim of 1.2 mm and
/// fat round it, in muscle. `rim`: signal of the rim.
ScanImage phalanx(double rim, double threshold) {
  ScanImage scan;
  imaging::VolumeGrid& grid = scan.image.grid;
  grid.size = {40, 40, 40};
  grid.spacing = Vec3::Constant(0.6);
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) {
        const Vec3 p = 0.6 * Vec3(i - 19.5, j - 19.5, k - 19.5);
        // Negative inside the marrow, mm.
        const double beyond = std::max(std::hypot(p.x(), p.y()) - 2.5, std::abs(p.z()) - 7.0);
        const double signal = beyond < 0.0   ? kBright
                              : beyond < 1.2 ? rim
                              : beyond < 3.0 ? kBright
                                             : kMuscle;
        scan.image.value.push_back(static_cast<float>(signal));
      }
    }
  }
  scan.smooth = scan.image;
  scan.depth.assign(grid.count(), 10.0F);
  scan.levels.dark = kDark;
  scan.levels.bright = kBright;
  scan.levels.bone_threshold = threshold;
  return scan;
}

/// Volume of the largest candidate in the rim, mm^3; 0: none.
double found(const ScanImage& scan) {
  const MarrowRegions regions = marrow_regions(scan, imaging::VoxelMask(scan.depth.size(), 1));
  double most = 0.0;
  for (const MarrowRegion& region : regions.candidates) {
    bool is_marrow = true;
    for (const Vec3& voxel : region.voxels) {
      const Vec3 p = voxel - Vec3::Constant(0.6 * 19.5);
      is_marrow = is_marrow && std::hypot(p.x(), p.y()) < 3.0 && std::abs(p.z()) < 7.5;
    }
    if (is_marrow) most = std::max(most, region.volume);
  }
  return most;
}

constexpr double kMarrowVolume = 275.0;  // pi 2.5^2 14 mm^3
constexpr double kHalfWay = 0.5 * (kDark + kBright);

TEST(MarrowRegions, ADarkRimEnclosesMarrow) {
  EXPECT_NEAR(found(phalanx(kDark, kHalfWay)), kMarrowVolume, 0.12 * kMarrowVolume);
}

TEST(MarrowRegions, AHigherBoneThresholdFindsMarrowInAGreyRim) {
  // At two thirds of the way the rim isn't taken for bone, unless the user says that it is.
  const double grey = kDark + 0.67 * (kBright - kDark);
  EXPECT_EQ(found(phalanx(grey, kHalfWay)), 0.0);
  const double higher = kDark + 0.75 * (kBright - kDark);
  EXPECT_NEAR(found(phalanx(grey, higher)), kMarrowVolume, 0.12 * kMarrowVolume);
}

TEST(MarrowRegions, FatWithoutARimIsNoMarrowAtAnyThreshold) {
  EXPECT_EQ(found(phalanx(kBright, kHalfWay)), 0.0);
  EXPECT_EQ(found(phalanx(kBright, kBright)), 0.0);
}

}  // namespace
}  // namespace palmar::capture
