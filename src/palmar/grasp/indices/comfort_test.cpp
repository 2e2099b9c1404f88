// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/comfort.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

using ::testing::HasSubstr;

/// Vertices of 10 mm^2 each.
struct Skin {
  hand::Hand hand;
  contact::ContactResult contact;
  void add(hand::Region region, double pressure) {
    hand.region.push_back(region);
    contact.pressure.push_back(pressure);
    contact.force.push_back(10.0 * pressure);
  }
  void add_region(hand::Region region, double peak_cells, double mean) {
    contact::RegionContact one;
    one.region = region;
    one.peak_pressure = 2.0 * peak_cells;
    one.peak_pressure_cells = peak_cells;
    one.mean_pressure = mean;
    contact.regions.push_back(one);
  }
};

double value(const GraspIndices& rows, const std::string& key) {
  for (const GraspIndex& row : rows) {
    if (row.key == key) return row.value.value_or(-1.0);
  }
  ADD_FAILURE() << key << " is missing";
  return -2.0;
}

TEST(PressureThresholds, AreThoseOfTheirSources) {
  // ISO/TS 15066:2016, Table A.2: 300, 260, 200 N/cm^2. Johansson et al. 1999.
  EXPECT_EQ(pain_onset_film(hand::Region::kIndexDistal), 3.0);
  EXPECT_EQ(pain_onset_film(hand::Region::kCentralPalm), 2.6);
  EXPECT_EQ(pain_onset_film(hand::Region::kThenar), 2.0);
  EXPECT_EQ(pain_onset_film(hand::Region::kDorsum), 2.0);
  EXPECT_EQ(name_of(PressureFamily::kFilm), "film_peak");
  // The abstract of Johansson et al. 1999: discomfort at 38, 40 and 22 % of the onset of pain.
  for (const auto& [region, share] :
       {std::pair{hand::Region::kThumbDistal, 0.38}, std::pair{hand::Region::kHypothenar, 0.40},
        std::pair{hand::Region::kThenar, 0.22}}) {
    EXPECT_NEAR(discomfort_onset_probe(region) / pain_onset_probe(region), share, 0.006)
        << name_of(region);
  }
}

TEST(Comfort, EachQuestionHasItsScale) {
  Skin skin;
  skin.add(hand::Region::kIndexDistal, 0.04);  // blood flows
  skin.add(hand::Region::kIndexDistal, 0.06);  // it doesn't
  skin.add(hand::Region::kThenar, 0.45);
  skin.add(hand::Region::kThenar, 0.30);
  skin.add(hand::Region::kThenar, 0.0);                      // not in contact
  skin.add_region(hand::Region::kIndexDistal, 0.248, 0.05);  // half the onset of pain, 0.496
  skin.add_region(hand::Region::kThenar, 0.15, 0.1);  // 1.5 times the onset of discomfort, 0.100
  const ComfortResult found = assess_comfort(skin.hand, skin.contact);
  EXPECT_NEAR(found.area, 40.0, 1e-12);
  EXPECT_NEAR(found.sustained_area, 30.0, 1e-12);
  EXPECT_NEAR(found.sustained_share, 0.75, 1e-12);
  ASSERT_TRUE(found.pain && found.discomfort && found.film);
  EXPECT_EQ(found.pain->region, hand::Region::kIndexDistal);
  EXPECT_NEAR(found.pain->share(), 0.5, 1e-12);
  EXPECT_EQ(level_of(*found.pain), OnsetLevel::kNear);
  EXPECT_EQ(found.pain->above, 0);
  // Nearest to pain and most uncomfortable are different places: the thenar is the more sensitive.
  EXPECT_EQ(found.discomfort->region, hand::Region::kThenar);
  EXPECT_NEAR(found.discomfort->share(), 1.5, 1e-12);
  EXPECT_EQ(level_of(*found.discomfort), OnsetLevel::kAbove);
  EXPECT_EQ(found.discomfort->above, 2);  // 0.248 > 0.188, too

  const GraspIndices rows = to_indices(found);
  EXPECT_NEAR(value(rows, "pain_onset_percent"), 50.0, 1e-9);
  EXPECT_NEAR(value(rows, "discomfort_onset_percent"), 150.0, 1e-9);
  EXPECT_NEAR(value(rows, "regions_above_discomfort"), 2.0, 1e-12);
  EXPECT_NEAR(value(rows, "skin_above_50_kpa_mm2"), 30.0, 1e-12);
}

TEST(Comfort, WhatHurtsIsUncomfortable) {
  // One scale: nothing is said to hurt that isn't said to be uncomfortable, at any pressure.
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const auto region = static_cast<hand::Region>(r);
    for (double pressure = 0.02; pressure < 1.0; pressure += 0.02) {
      Skin skin;
      skin.add(region, pressure);
      skin.add_region(region, pressure, pressure);
      const ComfortResult found = assess_comfort(skin.hand, skin.contact);
      EXPECT_GT(found.discomfort->share(), found.pain->share());
      EXPECT_GE(found.discomfort->above, found.pain->above);
      EXPECT_GE(level_of(*found.discomfort), level_of(*found.pain));
    }
  }
}

TEST(Comfort, EveryRowSaysItsQuestionAndSource) {
  Skin skin;
  skin.add(hand::Region::kThenar, 0.2);
  skin.add_region(hand::Region::kThenar, 0.2, 0.1);
  for (const GraspIndex& row : to_indices(assess_comfort(skin.hand, skin.contact))) {
    EXPECT_EQ(row.group, "comfort");
    EXPECT_EQ(row.better, Better::kDown);
    const bool is_probe = row.source.find("Johansson") != row.source.npos;
    const bool is_flow = row.source.find("Chalmers") != row.source.npos;
    const bool is_film = row.source.find("15066") != row.source.npos;
    EXPECT_EQ(is_film, row.key.rfind("film_", 0) == 0) << row.key;
    EXPECT_EQ(is_flow, row.name.rfind("minutes: ", 0) == 0) << row.key;
    EXPECT_EQ(is_probe,
              row.name.rfind("a moment: ", 0) == 0 || row.name.rfind("repeated: ", 0) == 0)
        << row.key;
  }
}

TEST(Comfort, MorePressureIsNeverMoreComfortable) {
  double last = 0.0;
  for (const double p : {0.01, 0.05, 0.2, 0.5, 1.0, 3.0}) {
    Skin skin;
    skin.add(hand::Region::kThenar, p);
    skin.add(hand::Region::kThenar, 0.5 * p);
    skin.add_region(hand::Region::kThenar, p, 0.75 * p);
    const ComfortResult found = assess_comfort(skin.hand, skin.contact);
    const double sum = found.sustained_share + found.pain->share() + found.discomfort->share();
    EXPECT_GT(sum, last);
    last = sum;
  }
}

TEST(Comfort, NothingTouchedHasNoValues) {
  const ComfortResult found = assess_comfort(hand::Hand{}, contact::ContactResult{});
  EXPECT_FALSE(found.pain.has_value());
  for (const GraspIndex& row : to_indices(found)) {
    EXPECT_FALSE(row.value.has_value());
    EXPECT_THAT(row.remark, HasSubstr("nothing is touched"));
  }
}

TEST(Comfort, ContactOfAnotherHandIsRefused) {
  Skin skin;
  skin.add(hand::Region::kThenar, 0.2);
  EXPECT_THROW(assess_comfort(hand::Hand{}, skin.contact), UsageError);
}

}  // namespace
}  // namespace palmar::grasp
