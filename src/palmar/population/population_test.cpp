// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/population.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/survey_figures.h"

namespace palmar::population {
namespace {

using ::testing::HasSubstr;

constexpr hand::HandDimension kLength{hand::DimensionKind::kHandLength};
constexpr hand::HandDimension kCircumference{hand::DimensionKind::kHandCircumference};
constexpr hand::HandDimension kWidth{hand::DimensionKind::kHandWidth};
constexpr hand::HandDimension kPalm{hand::DimensionKind::kSegmentLength, hand::Segment::kPalm};

Stratum people() {
  Stratum stratum;
  stratum.name = "people";
  stratum.driving = {{kLength, 184.0, 10.4, ""}, {kCircumference, 193.0, 14.0, ""}};
  stratum.correlation = Eigen::Matrix2d{{1.0, 0.36}, {0.36, 1.0}};
  return stratum;
}

DimensionRegression regression(hand::HandDimension dimension, double intercept,
                               std::vector<DimensionRegression::Term> terms, double residual) {
  DimensionRegression one;
  one.dimension = dimension;
  one.intercept = intercept;
  one.terms = std::move(terms);
  one.residual_sd = residual;
  return one;
}

std::string message_of(const Population& population) {
  try {
    population.check();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Population, BuiltInOnesAreSoundAndReportTheirSources) {
  for (const Population& population : built_in_populations()) {
    EXPECT_EQ(message_of(population), "");
    EXPECT_FALSE(population.source.empty()) << population.name;
    EXPECT_FALSE(population.title.empty()) << population.name;
    for (const Stratum& stratum : population.strata) {
      for (const DrivingDimension& one : stratum.driving) EXPECT_FALSE(one.source.empty());
      for (const DimensionRegression& one : stratum.regressions) EXPECT_FALSE(one.source.empty());
    }
  }
}

TEST(Population, ThesisPresetIsAsPrinted) {
  const Population& thesis = population_named("xie2014");
  ASSERT_EQ(thesis.strata.size(), 1U);
  const Stratum& stratum = thesis.strata.front();
  EXPECT_EQ(stratum.driving[0].mean, 184.0);
  EXPECT_EQ(stratum.driving[0].sd, 10.4);
  EXPECT_EQ(stratum.driving[1].mean, 193.0);
  EXPECT_EQ(stratum.driving[1].sd, 14.0);
  EXPECT_EQ(stratum.correlation(0, 1), 0.36);
  ASSERT_FALSE(thesis.cautions.empty());
  EXPECT_THAT(thesis.cautions.front(), HasSubstr("Mixes the sexes"));
}

// Pooled means of the AIST survey, 178.0 and 193.5 mm (from the sexes' means and numbers).
TEST(Population, JapaneseSharesGiveThePooledMeans) {
  const Population& japanese = population_named("japanese");
  double length = 0.0, girth = 0.0;
  for (const Stratum& stratum : japanese.strata) {
    length += stratum.share * stratum.driving[0].mean;
    girth += stratum.share * stratum.driving[1].mean;
  }
  EXPECT_NEAR(length, 178.0, 0.05);
  EXPECT_NEAR(girth, 193.5, 0.05);
}

// Ibeachu et al. 2011: means 190.2 and 176.2, 85.8 and 76.9 mm; +- 0.8 mm of 150 as a standard
// error is a deviation of 9.8 mm. People of one sex scatter by 4 to 6 % of hand length and breadth
// in every survey at hand (ANSUR II, Greiner 1991, Kakkar & Kushwaha 2021), and so must these.
TEST(BuiltInPopulations, NigeriansHaveThePublishedMeansAndAScatterOfPeople) {
  const Population& both = population_named("nigerian");
  ASSERT_EQ(both.strata.size(), 2U);
  const double length[] = {190.2, 176.2}, breadth[] = {85.8, 76.9};
  for (int k = 0; k < 2; ++k) {
    const Stratum& one = both.strata[static_cast<std::size_t>(k)];
    EXPECT_DOUBLE_EQ(one.driving[0].mean, length[k]);
    EXPECT_DOUBLE_EQ(one.driving[1].mean, breadth[k]);
    for (const DrivingDimension& driving : one.driving) {
      EXPECT_GT(driving.sd / driving.mean, 0.04);
      EXPECT_LT(driving.sd / driving.mean, 0.065);
    }
  }
  EXPECT_FALSE(both.cautions.empty());
}

TEST(Population, UnknownNameReportsTheNearest) {
  try {
    population_named("ansur2_woman");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean ansur2_women?"));
  }
}

// What the figures come from: sqrt(4^2 - (50/200 * 12)^2) = sqrt(7), of 50 mm.
TEST(ResidualShare, IsWhatTheDriverLeaves) {
  EXPECT_NEAR(residual_share({50.0, 4.0}, {200.0, 12.0}), std::sqrt(7.0) / 50.0, 1e-12);
  EXPECT_EQ(residual_share({50.0, 2.0}, {200.0, 12.0}), 0.0);  // the driver explains more than all
}

// Correlation of palm and hand length in ANSUR II, 0.7946 (men) and 0.8387 (women), and the palm's
// coefficient of variation, 6.233 / 116.46 and 5.940 / 108.70, must come out of slope and residual.
TEST(SegmentRegressions, PalmScattersAsInTheSurvey) {
  const struct {
    const char* name;
    double r, variation;
  } truths[] = {{"ansur2_men", 0.7946, 6.233 / 116.46}, {"ansur2_women", 0.8387, 5.940 / 108.70}};
  for (const auto& truth : truths) {
    const Stratum& stratum = population_named(truth.name).strata.front();
    const DimensionMoments palm = moments_of(stratum, kPalm).value();
    EXPECT_NEAR(palm.sd / palm.mean, truth.variation, 2e-4);
    const double slope = stratum.regressions.front().terms.front().slope;
    EXPECT_NEAR(slope * stratum.driving.front().sd / palm.sd, truth.r, 2e-3);
  }
}

// Greiner's distal link of the index, 28.4 +- 2.3 mm at a hand length of 194.1 +- 9.9 mm: scatter
// about proportion sqrt(2.3^2 - (28.4 / 194.1 * 9.9)^2) / 28.4 = 6.29 %. In the model that is the
// scatter at given hand length, through the palm and by itself.
TEST(SegmentRegressions, FingersScatterAtGivenLengthAsInTheSource) {
  const Stratum& stratum = population_named("ansur2_men").strata.front();
  const hand::HandDimension distal{hand::DimensionKind::kSegmentLength,
                                   hand::Segment::kIndexDistal};
  for (const DimensionRegression& one : stratum.regressions) {
    if (one.dimension != distal) continue;
    const double mean = moments_of(stratum, distal)->mean;
    const double through_palm = one.terms[1].slope * stratum.regressions.front().residual_sd;
    EXPECT_NEAR(std::hypot(through_palm, one.residual_sd) / mean, 0.0629, 5e-5);
    return;
  }
  FAIL() << "no regression of the index finger's distal segment";
}

TEST(MomentsOf, FollowsRegressionsOnRegressions) {
  Stratum stratum = people();
  stratum.regressions = {regression(kWidth, 1.0, {{kCircumference, 0.4}}, 3.0),
                         regression(kPalm, 0.0, {{kLength, 0.5}, {kWidth, 0.1}}, 1.0)};
  EXPECT_EQ(fault_of(stratum), "");
  const DimensionMoments width = moments_of(stratum, kWidth).value();
  EXPECT_NEAR(width.mean, 78.2, 1e-12);
  EXPECT_NEAR(width.sd, std::hypot(5.6, 3.0), 1e-12);
  const DimensionMoments palm = moments_of(stratum, kPalm).value();
  EXPECT_NEAR(palm.mean, 92.0 + 7.82, 1e-12);
  const double covariance = 0.4 * 0.36 * 10.4 * 14.0;  // of length and width
  const double variance =
      0.25 * 10.4 * 10.4 + 0.01 * width.sd * width.sd + 2.0 * 0.5 * 0.1 * covariance + 1.0;
  EXPECT_NEAR(palm.sd, std::sqrt(variance), 1e-12);
  EXPECT_FALSE(moments_of(stratum, {hand::DimensionKind::kHandThickness}));
}

TEST(Population, RefusesWithStratumDimensionValueAndRange) {
  Population population{"test", "", {people()}, "", {}};
  EXPECT_EQ(message_of(population), "");
  population.strata[0].driving[0].sd = -1.0;
  EXPECT_THAT(message_of(population),
              HasSubstr("stratum \"people\": hand_length: standard deviation is -1 mm"));
  population.strata[0] = people();
  population.strata[0].driving[1].mean = 1930.0;
  EXPECT_THAT(message_of(population), HasSubstr("hand_circumference: mean is 1930 mm; 1 to 400"));
  population.strata[0] = people();
  population.strata[0].correlation(0, 1) = population.strata[0].correlation(1, 0) = 1.0;
  EXPECT_THAT(message_of(population), HasSubstr("is 1; between -1 and 1 is required"));
  population.strata[0] = people();
  population.strata[0].correlation(0, 1) = 0.5;
  EXPECT_THAT(message_of(population), HasSubstr("a symmetric matrix is required"));
  population.strata[0] = people();
  population.strata[0].share = 0.9;
  EXPECT_THAT(message_of(population), HasSubstr("shares of the strata add up to 0.9; 1"));
  population.strata[0] = people();
  population.strata[0].driving.push_back({kWidth, 80.0, 4.0, ""});
  population.strata[0].correlation =
      Eigen::Matrix3d{{1.0, 0.9, 0.9}, {0.9, 1.0, -0.9}, {0.9, -0.9, 1.0}};
  EXPECT_THAT(message_of(population), HasSubstr("a positive definite matrix is required"));
  population.strata[0] = people();
  population.strata[0].regressions = {regression(kPalm, 0.0, {{kWidth, 1.0}}, 0.0)};
  EXPECT_THAT(message_of(population),
              HasSubstr("predictor hand_width neither drives nor is regressed before"));
  population.strata[0].regressions = {regression(kPalm, -5.0, {}, 0.0)};
  EXPECT_THAT(message_of(population), HasSubstr("palm_length at the mean hand: mean is -5 mm"));
}

}  // namespace
}  // namespace palmar::population
