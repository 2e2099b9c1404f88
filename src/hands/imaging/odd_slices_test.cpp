// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/odd_slices.h"

#include <gmock/gmock.h>

#include "palmar/core/random.h"

namespace palmar::imaging {
namespace {

/// A ball in noise, seen in 40 slices.
Volume ball() {
  Volume image;
  image.grid.size = {32, 32, 40};
  image.value.resize(image.grid.count());
  RandomStream random(3, 0);
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 32; ++j) {
      for (int i = 0; i < 32; ++i) {
        const bool is_in = (Vec3(i, j, k) - Vec3(15.0, 16.0, 20.0)).norm() < 12.0;
        image.value[image.grid.at(i, j, k)] =
            static_cast<float>((is_in ? 100.0 : 10.0) + 4.0 * random.normal());
      }
    }
  }
  return image;
}

std::vector<int> found_in(const Volume& image) {
  std::vector<int> found;
  for (const OddSlice& one : odd_slices(image)) found.push_back(one.index);
  return found;
}

TEST(OddSlices, OfASoundImageThereAreNone) { EXPECT_THAT(found_in(ball()), testing::IsEmpty()); }

TEST(OddSlices, AnEmptyOrForeignSliceIsFound) {
  Volume image = ball();
  std::fill(image.value.begin() + static_cast<std::ptrdiff_t>(image.grid.at(0, 0, 18)),
            image.value.begin() + static_cast<std::ptrdiff_t>(image.grid.at(0, 16, 18)), 0.0F);
  for (std::size_t v = image.grid.at(0, 0, 30); v < image.grid.at(0, 0, 31); v += 50) {
    image.value[v] = 3e4F;  // few values, but far off
  }
  EXPECT_THAT(found_in(image), testing::ElementsAre(18, 30));
}

TEST(OddSlices, AnEdgeOrEveryOtherSliceIsSound) {
  Volume image = ball();
  for (std::size_t v = 0; v < image.value.size(); ++v) {
    const std::size_t k = v / image.grid.at(0, 0, 1);
    if (k > 25) image.value[v] += 80.0F;                // a flat face across the slices
    if (k % 2 == 1 && k < 20) image.value[v] *= 1.08F;  // cross-talk
  }
  EXPECT_THAT(found_in(image), testing::IsEmpty());
}

TEST(OddSlices, ImagesTooThinOrEvenHaveNone) {
  Volume image = ball();
  std::fill(image.value.begin(), image.value.end(), 7.0F);
  EXPECT_THAT(found_in(image), testing::IsEmpty());
  image.grid.size[2] = 3;
  image.value.resize(image.grid.count());
  EXPECT_THAT(found_in(image), testing::IsEmpty());
}

}  // namespace
}  // namespace palmar::imaging
