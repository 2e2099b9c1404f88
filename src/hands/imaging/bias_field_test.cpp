// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/bias_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hands/imaging/air_threshold.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/random.h"

namespace palmar::imaging {
namespace {

using ::testing::HasSubstr;

/// A shell, a body and a core of three brightnesses in air, 4.5 mm voxels, under a smooth field and
/// noise.
struct Phantom {
  Volume image;
  std::vector<double> truth, log_field;
};

Phantom make_phantom(double strength, double noise) {
  Phantom phantom;
  VolumeGrid& grid = phantom.image.grid;
  grid.size = {36, 38, 26};
  grid.spacing = Vec3(4.5, 4.5, 4.5);
  RandomStream random(5, 0);
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const Vec3 at((i - 18) / 16.0, (j - 19) / 17.0, (k - 13) / 11.0);
        const double r = at.norm();
        const double truth = r > 1.0 ? 0.0 : r > 0.8 ? 200.0 : r > 0.5 ? 110.0 : 60.0;
        const double field =
            strength * (-0.5 * at.y() + 0.2 * at.x() * at.x() + 0.2 * std::sin(2.0 * at.z()));
        phantom.truth.push_back(truth);
        phantom.log_field.push_back(field);
        phantom.image.value.push_back(
            static_cast<float>(std::abs(truth * std::exp(field) + noise * random.normal())));
      }
    }
  }
  return phantom;
}

/// Standard deviation of the logarithm of what is left of the field in tissue.
double unevenness(const Phantom& phantom, const Volume& corrected) {
  double sum = 0.0, square = 0.0, count = 0.0;
  for (std::size_t v = 0; v < phantom.truth.size(); ++v) {
    if (phantom.truth[v] == 0.0) continue;
    // The image's noise is in both and goes out.
    const double left = phantom.log_field[v] +
                        std::log(corrected.value[v] / static_cast<double>(phantom.image.value[v]));
    sum += left;
    square += left * left;
    count += 1.0;
  }
  return std::sqrt(square / count - sum * sum / count / count);
}

TEST(BiasField, KnownFieldIsTakenOut) {
  const Phantom phantom = make_phantom(0.6, 6.0);
  const double before = unevenness(phantom, phantom.image);
  const double after = unevenness(phantom, corrected_for_bias(phantom.image));
  EXPECT_GT(before, 0.12);
  EXPECT_LT(after, 0.2 * before);  // Tustison 2010 reports residuals of a few per cent
}

TEST(BiasField, AnEvenImageStaysAsItIs) {
  const Phantom phantom = make_phantom(0.0, 6.0);
  EXPECT_LT(unevenness(phantom, corrected_for_bias(phantom.image)), 0.01);
}

TEST(BiasField, IntensitiesKeepTheirLevel) {
  const Phantom phantom = make_phantom(0.6, 0.0);
  Volume brighter = phantom.image;
  for (float& value : brighter.value) value *= 8.0F;
  const Volume a = corrected_for_bias(phantom.image);
  const Volume b = corrected_for_bias(brighter);
  double log_ratio = 0.0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < a.value.size(); ++v) {
    if (phantom.truth[v] == 0.0) continue;
    EXPECT_NEAR(b.value[v], 8.0 * a.value[v], 1e-3 * b.value[v]);  // a factor changes nothing
    log_ratio += std::log(a.value[v] / static_cast<double>(phantom.image.value[v]));
    ++count;
  }
  EXPECT_NEAR(log_ratio / static_cast<double>(count), 0.0, 0.01);
}

TEST(BiasField, ThreadsDoNotMatterAndMasksDo) {
  const Phantom phantom = make_phantom(0.6, 6.0);
  set_thread_count(1);
  const Volume one = corrected_for_bias(phantom.image);
  set_thread_count(3);
  EXPECT_EQ(corrected_for_bias(phantom.image).value, one.value);
  set_thread_count(0);
  std::vector<std::uint8_t> mask;
  const double air = air_threshold(phantom.image);
  for (const float value : phantom.image.value) mask.push_back(value > air ? 1 : 0);
  EXPECT_EQ(corrected_for_bias(phantom.image, mask).value, one.value);
}

TEST(BiasField, WhatCannotBeIsNamed) {
  Volume image;
  image.grid.size = {4, 4, 4};
  image.value.assign(64, 0.0F);
  const auto message = [&](const std::vector<std::uint8_t>& mask, const BiasFieldOptions& options) {
    try {
      corrected_for_bias(image, mask, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({}, {}), HasSubstr("the image shows no tissue"));
  EXPECT_THAT(message({1, 1}, {}), HasSubstr("the mask has 2 voxels; 64 are required"));
  BiasFieldOptions options;
  options.levels = 9;
  EXPECT_THAT(message({}, options), HasSubstr("1 to 6 are allowed"));
}

TEST(AirThreshold, PartsTwoClassesInTheMiddleOfTheirGap) {
  Volume image;
  image.grid.size = {10, 10, 1};
  for (int v = 0; v < 100; ++v) image.value.push_back(v < 70 ? 10.0F : 110.0F);
  EXPECT_NEAR(air_threshold(image), 60.0, 0.2);  // a bin is 0.1
  image.value.assign(100, 7.0F);
  EXPECT_EQ(air_threshold(image), 7.0);
}

}  // namespace
}  // namespace palmar::imaging
