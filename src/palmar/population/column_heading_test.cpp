// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/column_heading.h"

#include <gtest/gtest.h>

namespace palmar::population {
namespace {

struct Expected {
  const char* header;
  const char* name;
  const char* unit;
  Quantity quantity;
  double factor;
};

TEST(ColumnHeading, NamesDimensionAndUnitInAnyUsualWay) {
  const Expected cases[] = {
      {"hand_length_mm", "hand_length", "mm", Quantity::kLength, 1.0},
      {"Hand length [mm]", "hand_length", "mm", Quantity::kLength, 1.0},
      {"handlength (cm)", "hand_length", "cm", Quantity::kLength, 10.0},
      {"HandLength_in", "hand_length", "in", Quantity::kLength, 25.4},
      {"Hand Breadth, inches", "hand_width", "inches", Quantity::kLength, 25.4},
      {"hand-circumference_m", "hand_circumference", "m", Quantity::kLength, 1000.0},
      {"palmlength_mm", "palm_length", "mm", Quantity::kLength, 1.0},
      {"wristcircumference_mm", "wrist_circumference", "mm", Quantity::kLength, 1.0},
      {"index_proximal_length_mm", "index_proximal_length", "mm", Quantity::kLength, 1.0},
      {"Index finger, distal phalanx, breadth [mm]", "index_distal_width", "mm", Quantity::kLength,
       1.0},
      {"middle_middle_length_mm", "middle_middle_length", "mm", Quantity::kLength, 1.0},
      {"Ring finger middle segment length (mm)", "ring_middle_length", "mm", Quantity::kLength,
       1.0},
      {"D5 proximal thickness mm", "little_proximal_thickness", "mm", Quantity::kLength, 1.0},
      {"Thumb span [mm]", "thumb_span", "mm", Quantity::kLength, 1.0},
      {"Hand length (right hand) [mm]", "hand_length_right_hand", "mm", Quantity::kLength, 1.0},
      {"grip_strength_n", "grip_strength", "n", Quantity::kOther, 1.0},
      {"Age [years]", "age", "years", Quantity::kAge, 1.0},
      {"age_months", "age", "months", Quantity::kAge, 1.0 / 12.0},
      {"age", "age", "", Quantity::kAge, 1.0},
      {"Subject", "subject", "", Quantity::kLabel, 1.0},
      {"sex", "sex", "", Quantity::kOther, 1.0},
      {"handlength", "hand_length", "", Quantity::kOther, 1.0},
      {"weight [kg]", "weight", "kg", Quantity::kOther, 1.0},
  };
  for (const Expected& expected : cases) {
    const ColumnHeading heading = heading_of(expected.header);
    EXPECT_EQ(heading.name, expected.name) << expected.header;
    EXPECT_EQ(heading.unit, expected.unit) << expected.header;
    EXPECT_EQ(heading.quantity, expected.quantity) << expected.header;
    EXPECT_NEAR(heading.factor, expected.factor, 1e-15) << expected.header;
    EXPECT_EQ(heading.dimension.has_value(), hand::hand_dimension_named(expected.name).has_value());
  }
}

TEST(ColumnHeading, KnowsEveryDimensionUnderItsOwnName) {
  for (const hand::HandDimension dimension : hand::all_hand_dimensions()) {
    const ColumnHeading heading = heading_of(name_of(dimension) + "_mm");
    ASSERT_TRUE(heading.dimension) << name_of(dimension);
    EXPECT_EQ(*heading.dimension, dimension) << name_of(dimension);
    EXPECT_TRUE(size_range(heading.name)) << name_of(dimension);
  }
}

TEST(ColumnHeading, OddHeadingsStayUsable) {
  EXPECT_EQ(heading_of("[mm]").quantity, Quantity::kLength);
  EXPECT_EQ(heading_of("()").name, "()");
  EXPECT_EQ(heading_of("???").name, "???");
  EXPECT_EQ(heading_of("_mm").unit, "mm");
  EXPECT_EQ(heading_of("L\xC3\xA4nge [mm]").name, "l\xC3\xA4nge");
  EXPECT_FALSE(heading_of("proximal length").dimension);
  EXPECT_FALSE(heading_of("thumb middle length").dimension);  // a thumb has no middle phalanx
  // The bone reaches from the knuckle; our segment begins at the crease of the palm side.
  EXPECT_FALSE(heading_of("index finger proximal phalanx length").dimension);
  EXPECT_FALSE(heading_of("index finger DIP joint breadth").dimension);  // not the phalanx's width
}

TEST(SizeRange, TakesInTheHandsOfSurveysInTheRightUnitOnly) {
  // Least and greatest of ANSUR II, men and women (Gordon et al. 2014), mm.
  const std::tuple<const char*, double, double> survey[] = {{"hand_length", 145, 239},
                                                            {"hand_width", 67, 105},
                                                            {"hand_circumference", 152, 248},
                                                            {"palm_length", 88, 140},
                                                            {"wrist_circumference", 124, 216}};
  for (const auto& [name, low, high] : survey) {
    const SizeRange range = *size_range(name);
    EXPECT_LT(range.low, low) << name;
    EXPECT_GT(range.high, high) << name;
    for (const double wrong : {0.1, 1.0 / 25.4, 10.0, 25.4, 1000.0}) {
      EXPECT_TRUE(high * wrong < range.low || low * wrong > range.high) << name << wrong;
    }
  }
  EXPECT_FALSE(size_range("thumb_span"));
}

}  // namespace
}  // namespace palmar::population
