// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/denoise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"

namespace palmar::imaging {
namespace {

using ::testing::HasSubstr;

/// Tissue of 100 for i < 20, of 200 beyond.
Volume step_image(double noise, const Vec3& spacing = Vec3::Ones()) {
  Volume image;
  image.grid.size = {40, 24, 24};
  image.grid.spacing = spacing;
  RandomStream random(2, 0);
  for (std::size_t v = 0; v < image.grid.count(); ++v) {
    image.value.push_back(
        static_cast<float>((v % 40 < 20 ? 100.0 : 200.0) + noise * random.normal()));
  }
  return image;
}

/// Root mean square of what an image differs from the clean one, of voxels with i in [from, to).
double error_of(const Volume& image, std::size_t from, std::size_t to) {
  double sum = 0.0, count = 0.0;
  for (std::size_t v = 0; v < image.value.size(); ++v) {
    if (v % 40 < from || v % 40 >= to) continue;
    sum += std::pow(image.value[v] - (v % 40 < 20 ? 100.0 : 200.0), 2);
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

TEST(Denoise, NoiseIsMeasured) {
  EXPECT_NEAR(noise_deviation(step_image(8.0)), 8.0, 0.6);
  EXPECT_EQ(noise_deviation(step_image(0.0)), 0.0);
}

TEST(Denoise, NoiseFallsAndTheBorderStays) {
  const Volume noisy = step_image(8.0);
  const Volume smooth = denoised(noisy);
  EXPECT_LT(error_of(smooth, 0, 17), 0.3 * error_of(noisy, 0, 17));
  // The two layers at the border still show 100 and 200: nothing flowed across.
  EXPECT_LT(error_of(smooth, 19, 21), 0.5 * error_of(noisy, 19, 21));
  double sum = 0.0;
  for (const float value : smooth.value) sum += value;
  double before = 0.0;
  for (const float value : noisy.value) before += value;
  EXPECT_NEAR(sum, before, 1e-6 * before);  // what flows off one voxel comes to another
}

TEST(Denoise, CoarseSlicesMixLess) {
  // With slices 4 mm apart little flows between them: a bright slice keeps more of its difference.
  const auto left = [](double slice) {
    Volume image = step_image(8.0, Vec3(1, 1, slice));
    for (std::size_t v = 0; v < image.value.size(); ++v) {
      if (v / 960 == 12) image.value[v] += 12.0F;  // 40 x 24 voxels in a slice
    }
    const Volume smooth = denoised(image);
    double mean = 0.0;
    for (std::size_t v = 12 * 960; v < 13 * 960; ++v) {
      mean += (smooth.value[v] - (v % 40 < 20 ? 100.0 : 200.0)) / 960.0;
    }
    return mean;
  };
  EXPECT_GT(left(4.0), 1.5 * left(1.0));
}

TEST(Denoise, ACleanImageAndThreadsChangeNothing) {
  const Volume clean = step_image(0.0);
  EXPECT_EQ(denoised(clean).value, clean.value);
  const Volume noisy = step_image(8.0);
  set_thread_count(1);
  const Volume one = denoised(noisy);
  set_thread_count(3);
  EXPECT_EQ(denoised(noisy).value, one.value);
  set_thread_count(0);
}

TEST(Denoise, OptionsAreChecked) {
  const auto message = [](const DenoiseOptions& options) {
    try {
      options.check();
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  DenoiseOptions options;
  options.edge = 0.0;
  EXPECT_THAT(message(options), HasSubstr("edge is 0"));
  options = {};
  options.iterations = -1;
  EXPECT_THAT(message(options), HasSubstr("0 to 1000 are allowed"));
}

}  // namespace
}  // namespace palmar::imaging
