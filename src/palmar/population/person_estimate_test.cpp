// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/person_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/population/built_in_populations.h"

namespace palmar::population {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr hand::HandDimension kL{hand::DimensionKind::kHandLength};
constexpr hand::HandDimension kC{hand::DimensionKind::kHandCircumference};
constexpr hand::HandDimension kW{hand::DimensionKind::kHandWidth};

/// L 180 +- 10, C 200 +- 12, r 0.6; W = 10 + 0.35 C +- 2.
Population two_drivers() {
  Stratum all;
  all.name = "all";
  all.driving = {{kL, 180.0, 10.0, "made up"}, {kC, 200.0, 12.0, "made up"}};
  all.correlation = Eigen::Matrix2d{{1.0, 0.6}, {0.6, 1.0}};
  all.regressions = {{.dimension = kW,
                      .intercept = 10.0,
                      .terms = {{kC, 0.35}},
                      .residual_sd = 2.0,
                      .source = "made up"}};
  return {"made", "Made up", {all}, "made up", {}};
}

const EstimatedDimension& at(const PersonEstimate& estimate, hand::HandDimension dimension) {
  for (const EstimatedDimension& one : estimate.dimensions) {
    if (one.dimension == dimension) return one;
  }
  throw std::logic_error("dimension missing");
}

TEST(PersonEstimate, FollowsTheRegressionOfOneOnTheOther) {
  // Two normal variables: E[C | L] = 200 + 0.6 * 12 / 10 (L - 180), SD 12 sqrt(1 - 0.36) = 9.6.
  const PersonEstimate one = estimate_person(two_drivers(), {KnownMeasure::of(kL, 190.0, 0.0)});
  EXPECT_NEAR(at(one, kL).value, 190.0, 1e-6);
  EXPECT_NEAR(at(one, kL).sd, 0.0, 1e-4);
  EXPECT_TRUE(at(one, kL).is_measured);
  EXPECT_NEAR(at(one, kC).value, 207.2, 1e-6);
  EXPECT_NEAR(at(one, kC).sd, 9.6, 1e-6);
  EXPECT_FALSE(at(one, kC).is_measured);
  // W hangs on L through C alone: 0.35 * 207.2 + 10; sqrt((0.35 * 9.6)^2 + 2^2).
  EXPECT_NEAR(at(one, kW).value, 82.52, 1e-6);
  EXPECT_NEAR(at(one, kW).sd, std::sqrt(3.36 * 3.36 + 4.0), 1e-6);
}

TEST(PersonEstimate, AMeasureOfItsOwnErrorIsWeighed) {
  // Prior variance 100, error variance 25: the measure counts 0.8.
  const PersonEstimate one = estimate_person(two_drivers(), {KnownMeasure::of(kL, 190.0, 5.0)});
  EXPECT_NEAR(at(one, kL).value, 188.0, 1e-6);
  EXPECT_NEAR(at(one, kL).sd, std::sqrt(20.0), 1e-6);
}

TEST(PersonEstimate, ASumIsSharedByItsParts) {
  KnownMeasure sum{{{kL, 1.0}, {kC, 1.0}}, 380.0, 0.0, "both"};
  EXPECT_NEAR(at(estimate_person(two_drivers(), {sum}), kL).value, 180.0, 1e-6);
  sum.value = 400.0;
  const PersonEstimate more = estimate_person(two_drivers(), {sum});
  // Shares of the covariances with the sum: L 100 + 72, C 144 + 72 of 388.
  EXPECT_NEAR(at(more, kL).value, 180.0 + 20.0 * 172.0 / 388.0, 1e-6);
  EXPECT_NEAR(at(more, kL).value + at(more, kC).value, 400.0, 1e-6);
}

TEST(PersonEstimate, StrataAreWeighedByWhatIsKnown) {
  Population both = two_drivers();
  both.strata.push_back(both.strata.front());
  both.strata[0].name = "small";
  both.strata[1].name = "large";
  both.strata[1].driving[0].mean = 200.0;
  both.strata[0].share = both.strata[1].share = 0.5;
  const auto known = [&](double length) {
    return estimate_person(both, {KnownMeasure::of(kL, length, 0.0)}).stratum_share;
  };
  EXPECT_NEAR(known(190.0)[0], 0.5, 1e-9);
  // Bayes: densities one and two deviations away, 1 / (1 + exp(-(0 - 2) ...)) with z = 0 and 2.
  EXPECT_NEAR(known(180.0)[0], 1.0 / (1.0 + std::exp(-2.0)), 1e-9);
}

TEST(PersonEstimate, TheMiddleFingerIsWhatHandAndPalmLeave) {
  const hand::HandDimension palm{hand::DimensionKind::kSegmentLength, hand::Segment::kPalm};
  const PersonEstimate one =
      estimate_person(population_named("ansur2_women"),
                      {KnownMeasure::of(kL, 181.0, 1.0), KnownMeasure::of(kC, 187.0, 1.0)});
  double middle = 0.0;
  for (const hand::Segment s : {hand::Segment::kMiddleProximal, hand::Segment::kMiddleMiddle,
                                hand::Segment::kMiddleDistal}) {
    middle += at(one, {hand::DimensionKind::kSegmentLength, s}).value;
  }
  EXPECT_NEAR(at(one, kL).value - at(one, palm).value, middle, 1e-6);
  for (const EstimatedDimension& dimension : one.dimensions) {
    EXPECT_GT(dimension.sd, 0.0) << name_of(dimension.dimension);
  }
  EXPECT_EQ(sizes_of(one).size() + 1, one.dimensions.size());
}

TEST(PersonEstimate, RareAndImpossibleMeasuresAreReported) {
  EXPECT_TRUE(estimate_person(two_drivers(), {KnownMeasure::of(kL, 200.0, 0.0)}).notes.empty());
  EXPECT_THAT(estimate_person(two_drivers(), {KnownMeasure::of(kL, 230.0, 0.0)}).notes.front(),
              HasSubstr("hand_length, 230 mm, is 5 standard deviations"));
  EXPECT_THAT([] { estimate_person(two_drivers(), {}); },
              ThrowsMessage<UsageError>(HasSubstr("one is needed")));
  EXPECT_THAT([] { estimate_person(two_drivers(), {KnownMeasure::of(kL, 0.0, 1.0)}); },
              ThrowsMessage<UsageError>(HasSubstr("1 to 400 mm is allowed")));
  const hand::HandDimension palm{hand::DimensionKind::kSegmentLength, hand::Segment::kPalm};
  EXPECT_THAT([&] { estimate_person(two_drivers(), {KnownMeasure::of(palm, 100.0, 1.0)}); },
              ThrowsMessage<UsageError>(HasSubstr("palm_length isn't among")));
}

}  // namespace
}  // namespace palmar::population
