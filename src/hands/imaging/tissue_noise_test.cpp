// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/tissue_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palmar::imaging {
namespace {

// Layers of 5 to 9 voxels across one axis, a slow wave along the others, air that is masked.
Volume layered(double sigma, std::vector<float>& depth) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, sigma);
  Volume image;
  image.grid.size = {40, 30, 20};
  image.grid.spacing = Vec3(0.8, 0.8, 1.0);
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 30; ++j) {
      for (int i = 0; i < 40; ++i) {
        const bool is_air = i < 4;
        const double tissue = (i / 7) % 2 == 0 ? 180.0 : 60.0;
        const double signal = tissue + 10.0 * std::sin(0.2 * j) + 5.0 * std::cos(0.3 * k);
        image.value.push_back(
            is_air ? 0.0F : static_cast<float>(std::hypot(signal + noise(random), noise(random))));
        depth.push_back(is_air ? 0.0F : 0.8F * static_cast<float>(i - 3));
      }
    }
  }
  return image;
}

TEST(TissueNoise, IsThatOfTheTissueWhereAirIsMasked) {
  for (const double sigma : {4.0, 12.0}) {
    std::vector<float> depth;
    const Volume image = layered(sigma, depth);
    EXPECT_NEAR(tissue_noise(image, depth, 1.5), sigma, 0.08 * sigma);
  }
}

TEST(TissueNoise, NothingDeepEnoughHasNone) {
  std::vector<float> depth;
  const Volume image = layered(4.0, depth);
  EXPECT_EQ(tissue_noise(image, depth, 100.0), 0.0);
}

}  // namespace
}  // namespace palmar::imaging
