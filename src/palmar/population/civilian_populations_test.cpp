// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/civilian_populations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/population/built_in_populations.h"
#include "palmar/population/hand_sample.h"

namespace palmar::population {
namespace {

/// Mean and standard deviation of a driving dimension over all strata, as of one sample of people.
DimensionMoments pooled(const Population& population, std::size_t dimension) {
  double mean = 0.0, square = 0.0;
  for (const Stratum& one : population.strata) mean += one.share * one.driving[dimension].mean;
  for (const Stratum& one : population.strata) {
    const DrivingDimension& driving = one.driving[dimension];
    square += one.share * (driving.sd * driving.sd + std::pow(driving.mean - mean, 2));
  }
  return {mean, std::sqrt(square)};
}

// DINED gives men and women together besides each for themselves: hand length, then breadth; mean,
// then deviation, mm. Half of each must come out there, within the rounding of three figures to
// 1 mm and numbers of men and women that aren't the same.
TEST(CivilianPopulations, HalfOfEachSexIsWhatTheSurveyHasOfBoth) {
  const struct {
    const char* name;
    double length, length_sd, breadth, breadth_sd;
  } truths[] = {{"dutch", 187, 13, 85, 7},
                {"dutch_over_60", 184, 12, 85, 6},
                {"dutch_over_80", 181, 13, 85, 6},
                {"dutch_children_4", 119, 7, 56, 3},
                {"dutch_children_5", 127, 7, 59, 3},
                {"dutch_children_6", 133, 7, 62, 3},
                {"dutch_children_7", 139, 7, 64, 3},
                {"dutch_children_8", 144, 7, 66, 3},
                {"dutch_children_9", 150, 8, 68, 4},
                {"dutch_children_10", 156, 9, 70, 4},
                {"dutch_children_11", 161, 9, 72, 4},
                {"dutch_children_12", 167, 11, 73, 5}};
  for (const auto& truth : truths) {
    const Population& population = population_named(truth.name);
    const DimensionMoments length = pooled(population, 0), breadth = pooled(population, 1);
    EXPECT_NEAR(length.mean, truth.length, 1.0) << truth.name;
    EXPECT_NEAR(length.sd, truth.length_sd, 1.0) << truth.name;
    EXPECT_NEAR(breadth.mean, truth.breadth, 1.0) << truth.name;
    EXPECT_NEAR(breadth.sd, truth.breadth_sd, 1.0) << truth.name;
  }
}

// Another country and another survey: the six of 4 and 5 years among the first children of the
// public records of Snyder et al. 1977 (University of Michigan for the US Consumer Product Safety
// Commission). Their standard scores among Dutch children of the same age and sex have a mean of 0
// within two standard errors, 2 / sqrt(6) = 0.8, and nobody is beyond three deviations.
TEST(CivilianPopulations, AmericanChildrenAreOfTheSizeOfDutchOnes) {
  const struct {
    bool is_girl;
    int age;
    double length, breadth;
  } children[] = {{true, 4, 120, 55}, {false, 4, 121, 56}, {true, 4, 121, 59},
                  {true, 5, 125, 59}, {false, 5, 123, 56}, {true, 4, 121, 55}};
  double length = 0.0, breadth = 0.0;
  for (const auto& child : children) {
    const Stratum& stratum = population_named("dutch_children_" + std::to_string(child.age))
                                 .strata[child.is_girl ? 1 : 0];
    EXPECT_EQ(stratum.name, child.is_girl ? "girls" : "boys");
    const auto score = [&](std::size_t k, double value) {
      return (value - stratum.driving[k].mean) / stratum.driving[k].sd;
    };
    EXPECT_LT(std::abs(score(0, child.length)), 3.0);
    EXPECT_LT(std::abs(score(1, child.breadth)), 3.0);
    length += score(0, child.length) / 6.0;
    breadth += score(1, child.breadth) / 6.0;
  }
  EXPECT_NEAR(length, 0.0, 0.8);
  EXPECT_NEAR(breadth, 0.0, 0.8);
}

// Percentiles that were published besides mean and deviation; a normal distribution must have them:
// Rodriguez-Vega 2024 (men 174.2 and 202.2 mm, women's breadth 69.4 and 86.5), Nag et al. 2003
// (154 and 184 mm). P5 and P95 are 1.645 deviations from the mean.
TEST(CivilianPopulations, HavePublishedPercentiles) {
  const auto percentiles = [](const std::string& name, std::size_t k) {
    const DrivingDimension& one = population_named(name).strata.front().driving[k];
    return std::pair(one.mean - 1.645 * one.sd, one.mean + 1.645 * one.sd);
  };
  const auto [men5, men95] = percentiles("mexican_men", 0);
  EXPECT_NEAR(men5, 174.2, 0.5);
  EXPECT_NEAR(men95, 202.2, 0.5);
  const auto [women5, women95] = percentiles("mexican_women", 1);
  EXPECT_NEAR(women5, 69.4, 0.5);
  EXPECT_NEAR(women95, 86.5, 0.5);
  const auto [indian5, indian95] = percentiles("indian_women", 0);
  EXPECT_NEAR(indian5, 154.0, 1.5);
  EXPECT_NEAR(indian95, 184.0, 1.5);
}

// Strength falls with age (Steiber 2016: 34.0 kg of men over 80, 53.5 of men of 30) and isn't known
// of children: nobody is said to be too weak.
TEST(CivilianPopulations, OldPeopleAreWeakerAndChildrensStrengthIsNotMadeUp) {
  const auto mean_strength = [](const std::string& name) {
    SamplingOptions options;
    options.hands = 200;
    double sum = 0.0;
    for (const HandSample& one : sample_hands(population_named(name), options)) {
      sum += one.grip_strength / 200.0;
    }
    return sum;
  };
  EXPECT_NEAR(mean_strength("dutch_over_80_men"), 34.0 * 9.80665, 15.0);
  EXPECT_NEAR(mean_strength("dutch_men"), 53.4 * 9.80665, 20.0);
  EXPECT_EQ(mean_strength("dutch_children_8"), 0.0);
}

}  // namespace
}  // namespace palmar::population
