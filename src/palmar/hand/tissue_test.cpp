// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tissue.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

const RegionTissue& of(const Tissue& tissue, Region region) {
  return tissue.region[index_of(region)];
}

TEST(DefaultTissue, StaysInsideTheRangesOfTheThesis) {
  const Tissue tissue = default_tissue();
  for (int r = 1; r < kRegionCount; ++r) {
    const RegionTissue& t = tissue.region[r];
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

TEST(DefaultTissue, LowAndHighAreTheEndsOfTheThesisRanges) {
  const Tissue tissue = default_tissue();
  const TissueStiffness& finger = of(tissue, Region::kMiddleDistal).half_space;
  EXPECT_EQ(finger.low, (StiffeningLaw{0.005, 0.070, 4.0}));  // MPa, mm
  EXPECT_EQ(finger.high, (StiffeningLaw{0.005, 0.120, 4.0}));
  const TissueStiffness& palm = of(tissue, Region::kThenar).half_space;
  EXPECT_EQ(palm.low, (StiffeningLaw{0.005, 0.040, 7.0}));
  EXPECT_EQ(palm.high, (StiffeningLaw{0.050, 0.080, 7.0}));
}

TEST(DefaultTissue, EveryRegionStiffensWithDepthAndHasASource) {
  for (const RegionTissue& t : default_tissue().region) {
    EXPECT_EQ(fault_of(t), "");
    EXPECT_GT(t.half_space.nominal.g_limit, t.half_space.nominal.g0);
    EXPECT_LT(t.half_space.low.g_limit, t.half_space.nominal.g_limit);
    EXPECT_LT(t.half_space.nominal.g_limit, t.half_space.high.g_limit);
    EXPECT_GT(t.neighbourhood, t.swelling_radius);
    EXPECT_FALSE(t.source.empty());
  }
}

TEST(DefaultTissue, ALayerOverBoneIsSofterThanTheHalfSpaceThatStandsForIt) {
  // A bonded layer answers up to 18 times as stiffly as a half-space of its modulus
  // (VALIDATION.md, closed form 5), so at full depth its tissue has to be softer.
  for (const RegionTissue& t : default_tissue().region) {
    for (const TissueLevel level : {TissueLevel::kLow, TissueLevel::kNominal, TissueLevel::kHigh}) {
      EXPECT_LT(law_at(t.layered, level).g_limit, law_at(t.half_space, level).g_limit);
    }
  }
}

TEST(DefaultTissue, PadsBelowTheFingersArePalm) {
  EXPECT_EQ(tissue_class_of(Region::kRadialPalm), TissueClass::kPalm);
  EXPECT_EQ(tissue_class_of(Region::kUlnarPalm), TissueClass::kPalm);
  EXPECT_EQ(tissue_class_of(Region::kThumbDistal), TissueClass::kFinger);
  EXPECT_EQ(tissue_class_of(Region::kDorsum), TissueClass::kDorsum);
  const Tissue tissue = default_tissue();
  EXPECT_DOUBLE_EQ(of(tissue, Region::kRadialPalm).half_space.nominal.limit_depth, 7.0);
  EXPECT_DOUBLE_EQ(of(tissue, Region::kThumbDistal).half_space.nominal.limit_depth, 4.0);
}

TEST(DefaultTissue, NamesItsSource) {
  EXPECT_NE(default_tissue().source.find("Xie 2014"), std::string::npos);
}

TEST(TissueClass, NamesReadBack) {
  for (const TissueClass one : {TissueClass::kFinger, TissueClass::kPalm, TissueClass::kDorsum}) {
    EXPECT_EQ(tissue_class_named(name_of(one)), one);
  }
  EXPECT_FALSE(tissue_class_named("nail"));
}

TEST(FaultOfTissue, NamesTheValueAndWhatIsAllowed) {
  RegionTissue tissue = finger_tissue();
  tissue.half_space.low.g0 = 0.02;
  EXPECT_EQ(fault_of(tissue),
            "half-space: G0 is 20, 5, 5 kPa (low, nominal, high); ascending values are required");
  tissue = finger_tissue();
  tissue.layered.high.g_limit = tissue.layered.high.g0 / 2;
  EXPECT_NE(fault_of(tissue).find("layered (high): G_lim is"), std::string::npos);
  tissue = finger_tissue();
  tissue.layered.nominal.limit_depth = 0.0;
  EXPECT_EQ(fault_of(tissue),
            "layered (nominal): limit depth is 0 mm; more than 0 and at most 100 mm is allowed");
  tissue = finger_tissue();
  tissue.poisson_layered = 0.6;
  EXPECT_EQ(fault_of(tissue), "Poisson's ratio of the layer is 0.6; 0 to 0.5 is allowed");
  tissue = finger_tissue();
  tissue.swelling_width = -1.0;
  EXPECT_EQ(fault_of(tissue),
            "width of the bulge is -1 mm; more than 0 and at most 100 mm is allowed");
  tissue = finger_tissue();
  tissue.half_space.nominal.g0 = std::nan("");
  EXPECT_NE(fault_of(tissue).find("half-space (nominal): G0 is nan kPa"), std::string::npos);
}

}  // namespace
}  // namespace palmar::hand
