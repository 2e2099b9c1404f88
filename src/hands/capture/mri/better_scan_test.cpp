// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "hands/capture/mri/scan_surfaces.h"

namespace palmar::capture {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string advice(const Vec3& voxel) {
  ScanSurfaces surfaces;
  surfaces.voxel = voxel;
  return better_scan(surfaces);
}

TEST(BetterScan, WhatIsFineEnoughIsNotToBeFiner) {
  for (const Vec3& voxel : {Vec3(0.78, 0.78, 1.0), Vec3(0.6, 0.6, 0.6), Vec3(1.0, 0.8, 0.8)}) {
    EXPECT_THAT(advice(voxel), Not(HasSubstr("finer"))) << voxel.transpose();
    EXPECT_THAT(advice(voxel), HasSubstr("less noise"));
  }
}

TEST(BetterScan, CoarseAndUnknownVoxelsAre) {
  for (const Vec3& voxel : {Vec3(0.78, 0.78, 1.5), Vec3(1.0, 1.0, 1.0), Vec3(0.0, 0.0, 0.0)}) {
    EXPECT_THAT(advice(voxel), HasSubstr("pixels of 0.8 mm, slices of 1 mm")) << voxel.transpose();
  }
}

}  // namespace
}  // namespace palmar::capture
