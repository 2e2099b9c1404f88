// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/noise_floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hands/imaging/iso_surface.h"

namespace palmar::imaging {
namespace {

// A half space with signal 80 ends at x = 10.3 mm; voxels of 0.8 mm are shares of it. Rician noise.
TEST(NoiseFloor, SurfaceAtHalfTheSignalLiesWhereTheBodyEnds) {
  constexpr double kSignal = 80.0, kSigma = 8.0, kEnd = 10.3;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, kSigma);
  Volume image;
  image.grid.size = {26, 60, 60};
  image.grid.spacing = Vec3::Constant(0.8);
  for (std::size_t v = 0; v < image.grid.count(); ++v) {
    const double x = 0.8 * static_cast<double>(v % 26);
    const double share = std::clamp((kEnd - x) / 0.8 + 0.5, 0.0, 1.0);
    image.value.push_back(
        static_cast<float>(std::hypot(share * kSignal + noise(random), noise(random))));
  }
  const auto mean_end = [&](const Volume& of, double level) {
    double sum = 0.0, count = 0.0;
    for (const Vec3& p : iso_surface(of, level).vertices) {
      if (p.x() < 8.0 || p.x() > 12.0) continue;
      if (p.y() < 0.5 || p.y() > 46.5 || p.z() < 0.5 || p.z() > 46.5) continue;
      sum += p.x();
      count += 1.0;
    }
    return sum / count;
  };
  const double naive = mean_end(image, 0.5 * (kSignal + kSigma * std::sqrt(std::acos(0.0))));
  const double found = mean_end(without_noise_floor(image, kSigma), 0.5 * kSignal);
  EXPECT_NEAR(found, kEnd, 0.03);
  EXPECT_LT(naive, kEnd - 0.03);
}

TEST(NoiseFloor, IsTakenOutAndPutBack) {
  for (const double signal : {0.0, 3.0, 50.0}) {
    EXPECT_NEAR(without_noise_floor(with_noise_floor(signal, 4.0), 4.0), signal, 1e-6);
  }
  EXPECT_EQ(without_noise_floor(7.0, 0.0), 7.0);
  EXPECT_LT(without_noise_floor(1.0, 4.0), 0.0);
}

}  // namespace
}  // namespace palmar::imaging
