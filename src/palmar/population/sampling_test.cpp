// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/hand_sample.h"

namespace palmar::population {
namespace {

using ::testing::HasSubstr;

constexpr hand::HandDimension kHandLength{hand::DimensionKind::kHandLength};
constexpr hand::HandDimension kHandCircumference{hand::DimensionKind::kHandCircumference};

double value_of(const HandSample& sample, hand::HandDimension dimension) {
  for (const hand::SizedDimension& one : sample.dimensions) {
    if (one.dimension == dimension) return one.value;
  }
  ADD_FAILURE() << "no " << name_of(dimension);
  return 0.0;
}

std::vector<double> values_of(const std::vector<HandSample>& hands, hand::HandDimension dimension) {
  std::vector<double> values;
  for (const HandSample& hand : hands) values.push_back(value_of(hand, dimension));
  return values;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double sd_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double correlation_of(const std::vector<double>& x, const std::vector<double>& y) {
  const double mx = mean_of(x), my = mean_of(y);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mx) * (y[i] - my);
  return sum / (static_cast<double>(x.size() - 1) * sd_of(x) * sd_of(y));
}

std::vector<HandSample> draw(const Population& population, SamplingDesign design, int hands,
                             std::uint64_t seed) {
  SamplingOptions options;
  options.design = design;
  options.hands = hands;
  options.seed = seed;
  return sample_hands(population, options);
}

// A population of one normal distribution, for laws that the built-in ones would blur.
Population one_normal(double rho) {
  Stratum stratum;
  stratum.name = "people";
  stratum.driving = {{kHandLength, 184.0, 10.4, ""}, {kHandCircumference, 193.0, 14.0, ""}};
  stratum.correlation = Eigen::Matrix2d{{1.0, rho}, {rho, 1.0}};
  return {"people", "People", {stratum}, "", {}};
}

// How often sampled moments fall outside their exact 95 % limits, over many seeds: of a normal
// sample the mean is normal, (n - 1) s^2 / sigma^2 is chi-square (here by Wilson & Hilferty's
// cube root, good to 1e-3 at n = 400), and atanh(r) is normal within 1/(2n) of atanh(rho).
TEST(SampleHands, MomentsLieInTheirLimitsForEveryStratumOfEveryPopulation) {
  constexpr int kHands = 400, kSeeds = 20;
  constexpr double kTwoSided = 1.959963984540054;  // of 95 %
  int outside = 0, judged = 0;
  std::uint64_t seed = 1;  // another one for every sample: equal streams would be equal scores
  for (const Population& population : built_in_populations()) {
    for (Stratum stratum : population.strata) {
      stratum.share = 1.0;
      const Population alone{"alone", "", {stratum}, "", {}};
      for (int sample = 0; sample < kSeeds; ++sample, ++seed) {
        const auto hands = draw(alone, SamplingDesign::kRandom, kHands, seed);
        for (std::size_t i = 0; i < stratum.driving.size(); ++i) {
          const DrivingDimension& one = stratum.driving[i];
          const auto values = values_of(hands, one.dimension);
          const double z_mean = (mean_of(values) - one.mean) / (one.sd / std::sqrt(kHands));
          const double df = kHands - 1.0;
          const double ratio = std::pow(sd_of(values) / one.sd, 2.0);
          const double z_sd =
              (std::cbrt(ratio) - (1.0 - 2.0 / (9.0 * df))) / std::sqrt(2.0 / (9.0 * df));
          outside += std::abs(z_mean) > kTwoSided ? 1 : 0;
          outside += std::abs(z_sd) > kTwoSided ? 1 : 0;
          judged += 2;
          for (std::size_t j = 0; j < i; ++j) {
            const double rho =
                stratum.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
            const double r = correlation_of(values, values_of(hands, stratum.driving[j].dimension));
            const double bias = rho / (2.0 * (kHands - 1.0));
            const double z_r = (std::atanh(r) - std::atanh(rho) - bias) * std::sqrt(kHands - 3.0);
            outside += std::abs(z_r) > kTwoSided ? 1 : 0;
            ++judged;
          }
        }
      }
    }
  }
  // 5 % are expected outside. The nine statistics of a sample hang together, so their count
  // scatters more than a binomial one: at most three times in variance if three dimensions were
  // one.
  const double expected = 0.05 * judged;
  EXPECT_NEAR(outside, expected, 3.3 * std::sqrt(3.0 * 0.95 * expected)) << judged << " judged";
}

// Mixtures and regressed dimensions: moments against what the model says, within five standard
// errors (never in 10^6 by chance for a mean; 600 comparisons).
TEST(SampleHands, RegressedDimensionsHaveTheModelsMoments) {
  constexpr int kHands = 20000;
  for (const Population& population : built_in_populations()) {
    if (population.strata.size() > 1) continue;
    const Stratum& stratum = population.strata.front();
    const auto hands = draw(population, SamplingDesign::kRandom, kHands, 11);
    for (const DimensionRegression& one : stratum.regressions) {
      const auto values = values_of(hands, one.dimension);
      const DimensionMoments model = moments_of(stratum, one.dimension).value();
      const double error = model.sd / std::sqrt(kHands);
      EXPECT_NEAR(mean_of(values), model.mean, 5.0 * error)
          << population.name << " " << name_of(one.dimension);
      EXPECT_NEAR(sd_of(values), model.sd, 5.0 * error / std::numbers::sqrt2)
          << population.name << " " << name_of(one.dimension);
    }
  }
}

// Pooled ANSUR II: 6 068 people, hand length 189.29 +- 11.506, circumference 203.86 +- 15.551 mm,
// correlation 0.7036 (public files). The two strata must give them back.
TEST(SampleHands, StrataTogetherMeetThePooledSurvey) {
  constexpr int kHands = 40000;
  const auto hands = draw(population_named("ansur2"), SamplingDesign::kRandom, kHands, 3);
  const auto length = values_of(hands, kHandLength), girth = values_of(hands, kHandCircumference);
  constexpr double kRoot = 200.0;  // of the number of hands
  EXPECT_NEAR(mean_of(length), 189.29, 4.0 * 11.506 / kRoot);
  EXPECT_NEAR(sd_of(length), 11.506, 4.0 * 11.506 / kRoot / std::numbers::sqrt2);
  EXPECT_NEAR(mean_of(girth), 203.86, 4.0 * 15.551 / kRoot);
  EXPECT_NEAR(sd_of(girth), 15.551, 4.0 * 15.551 / kRoot / std::numbers::sqrt2);
  EXPECT_NEAR(correlation_of(length, girth), 0.7036, 4.0 / kRoot);
}

TEST(SampleHands, HandKIsTheSameWhateverTheOthers) {
  const Population& population = population_named("ansur2");
  const auto few = draw(population, SamplingDesign::kRandom, 10, 42);
  const auto many = draw(population, SamplingDesign::kRandom, 100, 42);
  for (std::size_t k = 0; k < few.size(); ++k) {
    EXPECT_EQ(few[k].label, many[k].label);
    EXPECT_EQ(few[k].stratum, many[k].stratum);
    EXPECT_EQ(few[k].grip_strength, many[k].grip_strength);
    for (std::size_t d = 0; d < few[k].dimensions.size(); ++d) {
      EXPECT_EQ(few[k].dimensions[d].value, many[k].dimensions[d].value);
    }
  }
  const auto others = draw(population, SamplingDesign::kRandom, 10, 43);
  EXPECT_NE(value_of(few[0], kHandLength), value_of(others[0], kHandLength));
}

// Layers of the first dimension, and of what the second has beyond it.
TEST(LatinHypercube, EveryFactorHasOneHandInEveryLayer) {
  constexpr int kHands = 50;
  constexpr double kRho = 0.6;
  std::set<int> first, second;
  for (const HandSample& hand :
       draw(one_normal(kRho), SamplingDesign::kLatinHypercube, kHands, 4)) {
    const double a = (value_of(hand, kHandLength) - 184.0) / 10.4;
    const double b = (value_of(hand, kHandCircumference) - 193.0) / 14.0;
    const auto layer = [](double z) {
      return static_cast<int>(kHands * 0.5 * std::erfc(-z / std::numbers::sqrt2));
    };
    first.insert(layer(a));
    second.insert(layer((b - kRho * a) / std::sqrt(1.0 - kRho * kRho)));
  }
  EXPECT_EQ(std::ssize(first), kHands);
  EXPECT_EQ(std::ssize(second), kHands);
}

TEST(LatinHypercube, KeepsTheCorrelation) {
  const auto hands = draw(one_normal(0.6), SamplingDesign::kLatinHypercube, 5000, 8);
  EXPECT_NEAR(std::atanh(correlation_of(values_of(hands, kHandLength),
                                        values_of(hands, kHandCircumference))),
              std::atanh(0.6), 4.0 / std::sqrt(5000.0));
}

// Pairing at random would scatter by (1 - 0.36^2) / sqrt(29) = 0.16; three of these are 0.48.
TEST(LatinHypercube, EvenThirtyHandsHaveThePopulationsCorrelation) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto hands = draw(one_normal(0.36), SamplingDesign::kLatinHypercube, 30, seed);
    EXPECT_NEAR(correlation_of(values_of(hands, kHandLength), values_of(hands, kHandCircumference)),
                0.36, 0.08);
  }
}

TEST(LatinHypercube, MeansScatterFarLessThanThoseOfRandomDraws) {
  for (const hand::HandDimension dimension : {kHandLength, kHandCircumference}) {
    const auto means = [&](SamplingDesign design) {
      std::vector<double> list;
      for (std::uint64_t seed = 0; seed < 100; ++seed) {
        list.push_back(mean_of(values_of(draw(one_normal(0.36), design, 30, seed), dimension)));
      }
      return list;
    };
    // The mean of a stratified sample of n falls off as n^-1.5 (McKay, Beckman, Conover 1979).
    const std::vector<double> layered = means(SamplingDesign::kLatinHypercube);
    EXPECT_LT(sd_of(layered), 0.2 * sd_of(means(SamplingDesign::kRandom)));
    EXPECT_NEAR(mean_of(layered), dimension == kHandLength ? 184.0 : 193.0, 0.2);
  }
}

TEST(LatinHypercube, StrataGetHandsByTheirShares) {
  const auto hands = draw(population_named("ansur2"), SamplingDesign::kLatinHypercube, 30, 1);
  // 4082 : 1986 of 30 is 20.18 : 9.82.
  EXPECT_EQ(std::count_if(hands.begin(), hands.end(),
                          [](const HandSample& h) { return h.stratum == "men"; }),
            20);
  EXPECT_EQ(hands.size(), 30U);
}

TEST(BoundaryHands, LieOnTheEllipseThatHoldsNinetyFivePercent) {
  const double rho = 0.36;
  SamplingOptions options;
  options.design = SamplingDesign::kBoundary;
  const auto hands = sample_hands(one_normal(rho), options);
  ASSERT_EQ(hands.size(), 9U);
  EXPECT_EQ(hands[0].label, "mean");
  EXPECT_DOUBLE_EQ(value_of(hands[0], kHandLength), 184.0);
  for (std::size_t k = 1; k < hands.size(); ++k) {
    const double a = (value_of(hands[k], kHandLength) - 184.0) / 10.4;
    const double b = (value_of(hands[k], kHandCircumference) - 193.0) / 14.0;
    const double distance = (a * a - 2.0 * rho * a * b + b * b) / (1.0 - rho * rho);
    EXPECT_NEAR(distance, 5.991464547107979, 1e-9);  // chi-square, 2 degrees of freedom, 95 %
  }
  EXPECT_EQ(hands[2].label, "95 % ellipse, 45 deg");
  // Of many people 95 % lie inside it.
  int inside = 0;
  const auto people = draw(one_normal(rho), SamplingDesign::kRandom, 10000, 5);
  for (const HandSample& hand : people) {
    const double a = (value_of(hand, kHandLength) - 184.0) / 10.4;
    const double b = (value_of(hand, kHandCircumference) - 193.0) / 14.0;
    inside += (a * a - 2.0 * rho * a * b + b * b) / (1.0 - rho * rho) < 5.991464547107979 ? 1 : 0;
  }
  EXPECT_NEAR(inside, 9500, 4.0 * std::sqrt(10000.0 * 0.95 * 0.05));
}

TEST(PercentileHands, FifthWomanAndNinetyFifthMan) {
  SamplingOptions options;
  options.design = SamplingDesign::kPercentiles;
  const auto hands = sample_hands(population_named("ansur2"), options);
  ASSERT_EQ(hands.size(), 6U);
  EXPECT_EQ(hands[3].label, "P5 woman");
  EXPECT_NEAR(value_of(hands[3], kHandLength), 181.08 - 1.6448536 * 10.056, 1e-3);
  EXPECT_EQ(hands[2].label, "P95 man");
  EXPECT_NEAR(value_of(hands[2], kHandCircumference), 212.28 + 1.6448536 * 10.243, 1e-3);
  // Germans of 30 to 34 years, 165-169 cm: 33.7 kg (Steiber 2016).
  EXPECT_NEAR(hands[3].grip_strength, 33.7 * 9.80665, 1e-9);
}

// Palm and the middle finger's middle and distal segments never leave its proximal one nothing.
TEST(SampleHands, MiddleFingerKeepsAProximalSegment) {
  for (const Population& population : built_in_populations()) {
    if (population.strata.front().regressions.empty()) continue;
    for (const HandSample& hand : draw(population, SamplingDesign::kRandom, 10000, 6)) {
      const double rest =
          value_of(hand, kHandLength) -
          value_of(hand, {hand::DimensionKind::kSegmentLength, hand::Segment::kPalm}) -
          value_of(hand, {hand::DimensionKind::kSegmentLength, hand::Segment::kMiddleMiddle}) -
          value_of(hand, {hand::DimensionKind::kSegmentLength, hand::Segment::kMiddleDistal});
      // 8 mm on a hand of 176, where the mean is 22.6
      ASSERT_GT(rest, 8.0 / 176.0 * value_of(hand, kHandLength))
          << population.name << " hand " << hand.label;
    }
  }
}

// A convex section is at least twice as long round as it is broad: no hand is drawn flatter.
TEST(SampleHands, HandsAreNotBroaderThanTheirGirthAllows) {
  for (const char* name : {"ansur2", "japanese", "delhi_men", "nigerian", "mexican", "indian_women",
                           "dutch_over_80", "beijing_over_65", "dutch_children_4"}) {
    for (const int hands : {4, 30, 10000}) {
      for (const HandSample& hand :
           draw(population_named(name), SamplingDesign::kLatinHypercube, hands, 2)) {
        ASSERT_GT(value_of(hand, kHandCircumference),
                  2.0 * value_of(hand, {hand::DimensionKind::kHandWidth}))
            << name << " " << hand.label;
      }
    }
  }
}

TEST(SampleHands, TenThousandHandsInASecond) {
  const auto start = std::chrono::steady_clock::now();
  const auto hands = draw(population_named("ansur2"), SamplingDesign::kLatinHypercube, 10000, 1);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(hands.size(), 10000U);
#ifdef NDEBUG
  EXPECT_LT(seconds.count(), 1.0);
#endif
}

TEST(SamplingOptions, RefusesWithValueAndRange) {
  const auto message = [](SamplingOptions options) -> std::string {
    try {
      options.check();
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  SamplingOptions options;
  options.hands = 0;
  EXPECT_THAT(message(options), HasSubstr("number of hands is 0; 1 to 1000000"));
  options = {};
  options.boundary = 1.0;
  EXPECT_THAT(message(options), HasSubstr("share inside the boundary is 1"));
  options = {};
  options.percentiles = {0.0};
  EXPECT_THAT(message(options), HasSubstr("percentile is 0; 0.1 to 99.9"));
  EXPECT_EQ(sampling_design_named("boundary"), SamplingDesign::kBoundary);
  EXPECT_EQ(sampling_design_named("lhs"), SamplingDesign::kLatinHypercube);
  EXPECT_FALSE(sampling_design_named("bounded"));
}

}  // namespace
}  // namespace palmar::population
