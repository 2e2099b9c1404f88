// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue.h"

#include <gtest/gtest.h>

namespace palmar {
namespace {

const RegionTissue& of(const Tissue& tissue, Region region) {
  return tissue.region[static_cast<std::size_t>(region)];
}

TEST(DefaultTissue, StaysInsideTheRangesOfTheThesis) {
  const Tissue tissue = default_tissue();
  for (int r = 1; r < kRegionCount; ++r) {
    const RegionTissue& t = tissue.region[static_cast<std::size_t>(r)];
    const bool is_finger = r <= static_cast<int>(Region::kLittleDistal);
    const StiffeningLaw& law = t.half_space.nominal;
    EXPECT_DOUBLE_EQ(law.limit_depth, is_finger ? 4.0 : 7.0);  // mm
    EXPECT_GE(law.g0, 0.005);                                  // MPa
    EXPECT_LE(law.g0, is_finger ? 0.005 : 0.050);
    EXPECT_GE(law.g_limit, is_finger ? 0.070 : 0.040);
    EXPECT_LE(law.g_limit, is_finger ? 0.120 : 0.080);
    EXPECT_DOUBLE_EQ(t.swelling_height, is_finger ? 2.0 : 3.0);   // mm, Table 3-2
    EXPECT_DOUBLE_EQ(t.swelling_radius, is_finger ? 8.0 : 15.0);  // mm, Table 3-2
  }
}

TEST(DefaultTissue, EveryRegionStiffensWithDepth) {
  for (const RegionTissue& t : default_tissue().region) {
    for (const StiffeningLaw& law : {t.half_space.low, t.half_space.nominal, t.half_space.high}) {
      EXPECT_GT(law.g0, 0.0);
      EXPECT_GT(law.g_limit, law.g0);
      EXPECT_GT(law.limit_depth, 0.0);
    }
    EXPECT_LT(t.half_space.low.g_limit, t.half_space.nominal.g_limit);
    EXPECT_LT(t.half_space.nominal.g_limit, t.half_space.high.g_limit);
    EXPECT_GT(t.neighbourhood, t.swelling_radius);
  }
}

TEST(DefaultTissue, PadsBelowTheFingersArePalm) {
  const Tissue tissue = default_tissue();
  EXPECT_DOUBLE_EQ(of(tissue, Region::kRadialPalm).half_space.nominal.limit_depth, 7.0);
  EXPECT_DOUBLE_EQ(of(tissue, Region::kUlnarPalm).half_space.nominal.limit_depth, 7.0);
  EXPECT_DOUBLE_EQ(of(tissue, Region::kThumbDistal).half_space.nominal.limit_depth, 4.0);
}

TEST(DefaultTissue, NamesItsSource) {
  EXPECT_NE(default_tissue().source.find("Xie 2014"), std::string::npos);
}

}  // namespace
}  // namespace palmar
