// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/skin_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "palmar/core/random.h"

namespace palmar::capture {
namespace {

using Spots = std::vector<std::vector<SkinSample>>;

const Eigen::Vector3f kLightSkin(0.60F, 0.32F, 0.21F), kDarkSkin(0.12F, 0.06F, 0.035F);

/// 300 spots seen by ten photographs; `own` and `mirrored` are asked for every sample's own light
/// (as a share of the usual) and mirrored one (of the same); noise as a share of each channel.
Spots spots_of(const Eigen::Vector3f& skin, double noise,
               const std::function<double(int spot, int photograph)>& own,
               const std::function<double(int spot, int photograph)>& mirrored) {
  Spots spots(300);
  for (int s = 0; s < 300; ++s) {
    RandomStream random(7, static_cast<std::uint64_t>(s));
    const double shade = 0.4 + 0.6 * random.uniform();
    for (int p = 0; p < 10; ++p) {
      Eigen::Vector3f light = static_cast<float>(shade * own(s, p)) * skin;
      light.array() += static_cast<float>(shade * mirrored(s, p)) * skin.sum() / 3.0F;
      for (int k = 0; k < 3; ++k) light[k] *= static_cast<float>(1.0 + noise * random.normal());
      spots[s].push_back({static_cast<std::size_t>(p), light});
    }
  }
  return spots;
}

TEST(SkinLight, MattSkinHasNeitherGlossNorMovedLamps) {
  for (const Eigen::Vector3f& skin : {kLightSkin, kDarkSkin}) {
    const auto one = [](int, int) { return 1.0; };
    const auto none = [](int, int) { return 0.0; };
    EXPECT_NEAR(judge_skin_light(spots_of(skin, 0.0, one, none)).gloss, 0.0, 1e-5);
    const SkinLight noisy = judge_skin_light(spots_of(skin, 0.05, one, none));
    EXPECT_LT(noisy.gloss, 0.02);
    EXPECT_LT(noisy.change, 0.05);
    EXPECT_EQ(noisy.spots, 300U);
  }
}

// A fifth of the photographs see a lamp mirrored that is half as bright as the skin.
TEST(SkinLight, MirroredLightIsGloss) {
  for (const Eigen::Vector3f& skin : {kLightSkin, kDarkSkin}) {
    const SkinLight light = judge_skin_light(spots_of(
        skin, 0.02, [](int, int) { return 1.0; },
        [](int s, int p) { return (s + p) % 5 == 0 ? 0.5 : 0.0; }));
    // 5 % and 95 % of the samples: those in the lamp's image and a few of the noise.
    EXPECT_NEAR(light.gloss, 0.5, 0.1);
    EXPECT_LT(light.change, 0.05);
  }
}

// A third of the photographs each in a light that makes the skin a quarter brighter, or darker, or
// neither: a deviation of 0.25 sqrt(2/3), of ten samples sqrt(10/9) more.
TEST(SkinLight, MovedLampsChangeItsOwnLight) {
  const SkinLight light = judge_skin_light(spots_of(
      kLightSkin, 0.02, [](int s, int p) { return 1.0 + 0.25 * ((s + p) % 3 - 1); },
      [](int, int) { return 0.0; }));
  EXPECT_NEAR(light.change, 0.25 * std::sqrt(2.0 / 3.0 * 10.0 / 9.0), 0.02);
  EXPECT_LT(light.gloss, 0.04);  // brighter samples have more noise
}

TEST(SkinLight, GreyDeterminesNothing) {
  const SkinLight light = judge_skin_light(spots_of(
      Eigen::Vector3f::Constant(0.3F), 0.0, [](int, int) { return 1.0; },
      [](int s, int p) { return (s + p) % 5 == 0 ? 0.5 : 0.0; }));
  EXPECT_EQ(light.spots, 0U);
  EXPECT_EQ(light.gloss, 0.0);
  EXPECT_EQ(judge_skin_light({}).spots, 0U);
}

}  // namespace
}  // namespace palmar::capture
