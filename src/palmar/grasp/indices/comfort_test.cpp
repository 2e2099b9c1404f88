// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/comfort.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar {
namespace {

using ::testing::HasSubstr;

/// Vertices of 10 mm^2 each.
struct Skin {
  Hand hand;
  ContactResult contact;
  void add(Region region, double pressure) {
    hand.region.push_back(region);
    contact.pressure.push_back(pressure);
    contact.force.push_back(10.0 * pressure);
  }
  void add_region(Region region, double peak_cells, double mean) {
    RegionContact one;
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
  // ISO/TS 15066:2016, Table A.2: 300, 260, 200 N/cm^2. Johansson et al. 1999: 38, 40, 22 %.
  EXPECT_EQ(pain_onset_film(Region::kIndexDistal), 3.0);
  EXPECT_EQ(pain_onset_film(Region::kCentralPalm), 2.6);
  EXPECT_EQ(pain_onset_film(Region::kThenar), 2.0);
  EXPECT_EQ(discomfort_over_pain(Region::kThumbDistal), 0.38);
  EXPECT_EQ(discomfort_over_pain(Region::kHypothenar), 0.40);
  EXPECT_EQ(discomfort_over_pain(Region::kThenar), 0.22);
  EXPECT_EQ(name_of(PressureFamily::kFilm), "film_peak");
}

TEST(Comfort, SharesCountAreaAboveEachThreshold) {
  Skin skin;
  skin.add(Region::kIndexDistal, 0.04);  // below everything
  skin.add(Region::kIndexDistal, 0.06);  // blood flow
  skin.add(Region::kThenar, 0.45);       // above 0.22 x 2.0 = 0.44: discomfort, film
  skin.add(Region::kThenar, 2.1);        // pain, film
  skin.add(Region::kThenar, 0.0);        // not in contact
  skin.add_region(Region::kIndexDistal, 0.05, 0.05);
  skin.add_region(Region::kThenar, 1.2, 0.6);
  const ComfortResult found = assess_comfort(skin.hand, skin.contact);
  EXPECT_NEAR(found.area, 40.0, 1e-12);
  EXPECT_NEAR(found.sustained_area, 30.0, 1e-12);
  EXPECT_NEAR(found.sustained_share, 0.75, 1e-12);
  EXPECT_NEAR(found.film_discomfort_share, 0.5, 1e-12);
  EXPECT_NEAR(found.film_pain_share, 0.25, 1e-12);
  // Algometer: index 0.05 > 0.038 and thenar 0.6 > 0.022: both; pain from 0.1 MPa: thenar alone.
  EXPECT_NEAR(found.algometer_discomfort_share, 1.0, 1e-12);
  EXPECT_NEAR(found.algometer_pain_share, 0.5, 1e-12);

  const GraspIndices rows = to_indices(found);
  EXPECT_NEAR(value(rows, "film_peak_of_pain_onset_percent"), 60.0, 1e-9);  // 1.2 of 2.0
  EXPECT_NEAR(value(rows, "algometer_mean_of_discomfort_onset_percent"), 100.0 * 0.6 / 0.022, 1e-9);
  EXPECT_NEAR(value(rows, "skin_above_50_kpa_mm2"), 30.0, 1e-12);
}

TEST(Comfort, RegionMostAtRiskMayDifferBetweenFamilies) {
  Skin skin;
  skin.add(Region::kIndexDistal, 1.0);
  skin.add(Region::kThenar, 0.05);
  skin.add_region(Region::kIndexDistal, 0.9, 0.03);  // sharp, but little on the whole
  skin.add_region(Region::kThenar, 0.05, 0.05);
  const ComfortResult found = assess_comfort(skin.hand, skin.contact);
  ASSERT_TRUE(found.most_at_risk_film && found.most_at_risk_algometer);
  EXPECT_EQ(found.regions[*found.most_at_risk_film].region, Region::kIndexDistal);
  EXPECT_EQ(found.regions[*found.most_at_risk_algometer].region, Region::kThenar);
}

TEST(Comfort, EveryRowSaysItsFamily) {
  Skin skin;
  skin.add(Region::kThenar, 0.2);
  skin.add_region(Region::kThenar, 0.2, 0.1);
  int film = 0, algometer = 0, sustained = 0;
  for (const GraspIndex& row : to_indices(assess_comfort(skin.hand, skin.contact))) {
    EXPECT_EQ(row.group, "comfort");
    EXPECT_EQ(row.better, Better::kDown);
    const bool is_film = row.key.rfind("film_", 0) == 0;
    const bool is_algometer = row.key.rfind("algometer_", 0) == 0;
    EXPECT_EQ(is_film, row.name.rfind("film family", 0) == 0) << row.key;
    EXPECT_EQ(is_algometer, row.name.rfind("algometer family", 0) == 0) << row.key;
    EXPECT_EQ(is_film, row.source.find("15066") != row.source.npos) << row.key;
    EXPECT_EQ(is_algometer, row.source.find("Harih") != row.source.npos) << row.key;
    film += is_film ? 1 : 0;
    algometer += is_algometer ? 1 : 0;
    sustained += !is_film && !is_algometer ? 1 : 0;
  }
  EXPECT_EQ(film, 3);
  EXPECT_EQ(algometer, 3);
  EXPECT_EQ(sustained, 2);
}

TEST(Comfort, MorePressureIsNeverMoreComfortable) {
  double last = 0.0;
  for (const double p : {0.01, 0.05, 0.2, 0.5, 1.0, 3.0}) {
    Skin skin;
    skin.add(Region::kThenar, p);
    skin.add(Region::kThenar, 0.5 * p);
    skin.add_region(Region::kThenar, p, 0.75 * p);
    const ComfortResult found = assess_comfort(skin.hand, skin.contact);
    const double sum = found.sustained_share + found.film_discomfort_share + found.film_pain_share +
                       found.algometer_discomfort_share + found.algometer_pain_share;
    EXPECT_GE(sum, last);
    last = sum;
  }
}

TEST(Comfort, NothingTouchedHasNoValues) {
  const ComfortResult found = assess_comfort(Hand{}, ContactResult{});
  EXPECT_FALSE(found.most_at_risk_film.has_value());
  for (const GraspIndex& row : to_indices(found)) {
    EXPECT_FALSE(row.value.has_value());
    EXPECT_THAT(row.remark, HasSubstr("nothing is touched"));
  }
}

TEST(Comfort, ContactOfAnotherHandIsRefused) {
  Skin skin;
  skin.add(Region::kThenar, 0.2);
  EXPECT_THROW(assess_comfort(Hand{}, skin.contact), UsageError);
}

}  // namespace
}  // namespace palmar
