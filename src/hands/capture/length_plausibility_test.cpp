// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/length_plausibility.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "palmar/population/built_in_populations.h"

namespace palmar::capture {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// ANSUR II (Gordon et al. 2014), public files: hand length, circumference, breadth; their
/// correlations; palm length (wrist's crease to the middle finger's base crease) on hand length.
struct Survey {
  double length, length_sd, girth, girth_sd, breadth, breadth_sd;
  double r_lc, r_lw, r_cw;
  double palm, palm_slope, palm_residual;
};
constexpr Survey kMen{193.28, 9.946,  212.28, 10.243, 88.26,   4.388,
                      0.5905, 0.5817, 0.9217, 116.46, 0.49788, 3.785};
constexpr Survey kWomen{181.08, 10.056, 186.55, 8.820,  78.15,   3.843,
                        0.5623, 0.5697, 0.8934, 108.70, 0.49544, 3.236};

/// A person of the survey. `ruler`: 0: base creases as in the survey, whose fingers have 40 % of
/// the hand; 1: as the template's, 45 %.
struct Person {
  double length = 0.0;
  RestOfHand rest;
};

class Crowd {
 public:
  explicit Crowd(unsigned seed) : engine_(seed) {}

  Person person(double ruler) {
    const Survey& s = uniform() < 0.5 ? kMen : kWomen;
    // Cholesky's factor of the three correlations.
    const double z1 = normal(), z2 = normal(), z3 = normal();
    const double b = std::sqrt(1.0 - s.r_lc * s.r_lc);
    const double c = (s.r_cw - s.r_lc * s.r_lw) / b;
    Person one;
    one.length = s.length + s.length_sd * z1;
    one.rest.circumference = s.girth + s.girth_sd * (s.r_lc * z1 + b * z2);
    one.rest.width = s.breadth + s.breadth_sd * (s.r_lw * z1 + c * z2 +
                                                 std::sqrt(1.0 - s.r_lw * s.r_lw - c * c) * z3);
    const double palm =
        s.palm + s.palm_slope * (one.length - s.length) + s.palm_residual * normal();
    const double longer = (1.0 - ruler) + ruler * 0.448 / (1.0 - s.palm / s.length);
    const double middle = longer * (one.length - palm);
    // Of fingers of other lengths than the middle one's: those of free persons (phantom.md).
    one.rest.finger = {0.91 * middle * (1.0 + 0.03 * normal()), middle,
                       0.93 * middle * (1.0 + 0.03 * normal()),
                       0.76 * middle * (1.0 + 0.03 * normal())};
    return one;
  }
  double uniform() { return std::uniform_real_distribution<>(0.0, 1.0)(engine_); }
  double normal() { return std::normal_distribution<>(0.0, 1.0)(engine_); }

 private:
  std::mt19937_64 engine_;
};

/// Share of a thousand hands that are named, their wrist's crease `off` too far from the fingers.
double named(double off, bool has_skin, double least_ruler, double largest_ruler) {
  Crowd crowd(7);
  const population::Population& people = population::population_named("ansur2");
  constexpr int kPeople = 1000;
  int count = 0;
  for (int k = 0; k < kPeople; ++k) {
    Person one = crowd.person(least_ruler + (largest_ruler - least_ruler) * crowd.uniform());
    if (has_skin) one.rest.by_skin = one.length + kLengthBySkinSd * crowd.normal();
    count += length_doubt(one.length + off, 0.0, one.rest, people).empty() ? 0 : 1;
  }
  return static_cast<double>(count) / kPeople;
}

// 99 % lie within; a thousand draws scatter by 0.3 % about 1 (standard deviation).
constexpr double kMostNamed = 0.01 + 2.0 * 0.0031;

TEST(ExpectedHandLength, FollowsTheSurveysRegressionOnBreadth) {
  RestOfHand rest;
  rest.width = kMen.breadth + kMen.breadth_sd;
  rest.width_sd = 0.0;
  const auto expected = expected_hand_length(rest, population::population_named("ansur2_men"));
  ASSERT_TRUE(expected.has_value());
  EXPECT_NEAR(expected->value, kMen.length + kMen.r_lw * kMen.length_sd, 0.01);
  EXPECT_NEAR(expected->sd, kMen.length_sd * std::sqrt(1.0 - kMen.r_lw * kMen.r_lw), 0.01);
  EXPECT_NEAR(expected->range(), 2.576 * expected->sd, 1e-9);  // 99 % of a normal distribution
}

TEST(ExpectedHandLength, LiesBetweenTheRulersOfSurveyAndTemplate) {
  // A hand of the survey's means: by the survey's own ruler its fingers are those of its hand, by
  // the template's those of one a tenth shorter. Half way.
  RestOfHand rest;
  const double middle = kMen.length - kMen.palm;
  rest.finger[1] = middle;
  const auto by_survey = expected_hand_length(rest, population::population_named("ansur2_men"));
  rest.finger[1] = 0.448 * kMen.length;
  const auto by_template = expected_hand_length(rest, population::population_named("ansur2_men"));
  ASSERT_TRUE(by_survey && by_template);
  EXPECT_LT(by_survey->value, kMen.length);
  EXPECT_GT(by_template->value, kMen.length);
  EXPECT_NEAR(0.5 * (by_survey->value + by_template->value), kMen.length, 1.0);
  // L given F as Gauss has it: F rises by 0.544 mm per mm of L and scatters by 3.47 mm (ANSUR II's
  // palm in the template's proportion), the ruler by 2.75 mm, the measure by 1.06 mm:
  // L's variance 98.9 - (0.544 * 98.9)^2 / (29.3 + 12.0 + 7.6 + 1.1) = 41.
  EXPECT_NEAR(by_survey->sd, 6.4, 0.1);
}

TEST(LengthDoubt, OrdinaryHandsAreNamedAsRarelyAsIsSaid) {
  EXPECT_LT(named(0.0, false, 0.0, 1.0), kMostNamed);
  EXPECT_LT(named(0.0, true, 0.0, 1.0), kMostNamed);
  // Were all of one ruler, some more.
  EXPECT_LT(named(0.0, false, 0.0, 0.0), 0.03);
  EXPECT_LT(named(0.0, false, 1.0, 1.0), 0.03);
}

TEST(LengthDoubt, AStrapTakenForTheWristsCreaseIsNamed) {
  // A reported hand came out 11.5 mm too long. By the skin's shape besides, its deviation is 2.7
  // mm: 95 % are beyond 2.576 of it. Without the skin people's palms vary too much.
  EXPECT_GT(named(11.5, true, 0.0, 1.0), 0.90);
  EXPECT_GT(named(11.5, false, 0.0, 1.0), 0.15);
  EXPECT_GT(named(20.0, false, 0.0, 1.0), 0.65);
}

TEST(LengthDoubt, SaysWhatIsExpectedAndWhereToLook) {
  RestOfHand rest;
  rest.width = kMen.breadth;
  rest.by_skin = kMen.length;
  const population::Population& people = population::population_named("ansur2_men");
  EXPECT_THAT(length_doubt(kMen.length, 0.0, rest, people), IsEmpty());
  // 8.2 mm by the breadth and 3 mm by the skin: 2.8 mm together, 7 mm on either side.
  EXPECT_THAT(length_doubt(kMen.length + 11.5, 0.0, rest, people),
              HasSubstr("Hand length is 205 mm, where the rest of the hand lets one expect 193 +- "
                        "7 mm (99 of 100 people): look where the crease of the wrist"));
  EXPECT_THAT(length_doubt(kMen.length - 11.5, 0.0, rest, people), HasSubstr("is 182 mm"));
  EXPECT_THAT(length_doubt(kMen.length + 11.5, 6.0, rest, people), IsEmpty());
}

TEST(LengthDoubt, OfAHandThatIsNoneOfThesePeoplesNothingIsSaid) {
  const population::Population& adults = population::population_named("ansur2");
  RestOfHand child;  // five years; Snyder et al. 1977
  child.width = 56.0;
  child.circumference = 135.0;
  child.finger[1] = 50.0;
  EXPECT_FALSE(expected_hand_length(child, adults).has_value());
  EXPECT_THAT(length_doubt(125.0, 0.0, child, adults), IsEmpty());
  EXPECT_FALSE(expected_hand_length({}, adults).has_value());
}

TEST(LengthDoubt, ReadsMeasuresOfAPhotograph) {
  const population::Population& people = population::population_named("ansur2_men");
  const hand::HandDimension length{hand::DimensionKind::kHandLength},
      width{hand::DimensionKind::kHandWidth};
  population::KnownMeasure index{{}, 70.0, 2.5, "index finger"};
  for (const hand::Segment s :
       {hand::Segment::kIndexProximal, hand::Segment::kIndexMiddle, hand::Segment::kIndexDistal}) {
    index.terms.push_back({{hand::DimensionKind::kSegmentLength, s}, 1.0});
  }
  const auto photo = [&](double hand) {
    return std::vector<population::KnownMeasure>{
        population::KnownMeasure::of(length, hand, 2.0),
        population::KnownMeasure::of(width, kMen.breadth, 1.2), index};
  };
  EXPECT_THAT(length_doubt(photo(183.0), people), IsEmpty());
  EXPECT_THAT(length_doubt(photo(213.0), people), HasSubstr("Hand length is 213 mm"));
  EXPECT_THAT(length_doubt({index}, people), IsEmpty());
}

}  // namespace
}  // namespace palmar::capture
