// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/distance_transform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hands/imaging/connected_parts.h"
#include "palmar/core/random.h"

namespace palmar::imaging {
namespace {

TEST(DistanceTransform, IsTheLeastOfAllDistances) {
  VolumeGrid grid;
  grid.size = {7, 6, 5};
  grid.spacing = {0.78, 1.3, 2.0};
  VoxelMask mask(grid.count(), 0);
  RandomStream random(5, 1);
  for (std::uint8_t& v : mask) v = random.uniform() < 0.06 ? 1 : 0;
  const std::vector<float> distance = distance_transform(grid, mask);
  const auto place = [&](std::size_t v) {
    return Vec3(0.78 * static_cast<double>(v % 7), 1.3 * static_cast<double>(v / 7 % 6),
                2.0 * static_cast<double>(v / 42));
  };
  for (std::size_t v = 0; v < mask.size(); ++v) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t w = 0; w < mask.size(); ++w) {
      if (mask[w] != 0) least = std::min(least, (place(v) - place(w)).norm());
    }
    EXPECT_NEAR(static_cast<double>(distance[v]), least, 1e-5);  // mm; float
  }
}

TEST(DistanceTransform, OfNothingIsInfinite) {
  VolumeGrid grid;
  grid.size = {2, 2, 2};
  EXPECT_TRUE(std::isinf(distance_transform(grid, VoxelMask(8, 0)).front()));
}

TEST(Opening, TakesOffAThinBridgeAndClosingFillsAGap) {
  VolumeGrid grid;
  grid.size = {11, 5, 5};
  VoxelMask blocks(grid.count(), 0), bridged;
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 11; ++i) {
        if (i != 5) blocks[grid.at(i, j, k)] = 1;
      }
    }
  }
  bridged = blocks;
  bridged[grid.at(5, 2, 2)] = 1;
  EXPECT_EQ(connected_parts(grid, bridged).count(), 1);
  EXPECT_EQ(connected_parts(grid, opened(grid, bridged, 1.5)).count(), 2);
  EXPECT_EQ(connected_parts(grid, closed(grid, blocks, 1.0)).count(), 1);
}

TEST(ConnectedParts, CornersConnectOnlyWhenAsked) {
  VolumeGrid grid;
  grid.size = {2, 2, 2};
  const VoxelMask mask = {1, 0, 0, 0, 0, 0, 0, 1};
  EXPECT_EQ(connected_parts(grid, mask).count(), 2);
  EXPECT_EQ(connected_parts(grid, mask, Neighbourhood::kCorners).count(), 1);
}

}  // namespace
}  // namespace palmar::imaging
