// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/paired_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palmar/statistics/statistics_test_data.h"
#include "palmar/statistics/walsh_averages.h"

namespace palmar::statistics {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Figures of R 4.2.2, tests/r/paired_tests.R: t.test(paired = TRUE), the interval of dz by
/// uniroot() of pt() in its ncp, wilcox.test(paired = TRUE, conf.int = TRUE), t.test().
struct PairedInR {
  double difference, low, high, t, df, p;
  double dz, dz_low, dz_high;
  double v, v_p;
  bool is_exact;
  double shift, shift_low, shift_high;
  double welch_t, welch_df, welch_p, welch_low, welch_high;
};

void expect_paired(const std::vector<double>& a, const std::vector<double>& b,
                   const PairedInR& in_r) {
  const PairedTest t = paired_t_test(a, b);
  expect_as_in_r(t.difference, in_r.difference, "difference");
  expect_as_in_r(t.interval.low, in_r.low, "low");
  expect_as_in_r(t.interval.high, in_r.high, "high");
  expect_as_in_r(t.t, in_r.t, "t");
  EXPECT_EQ(t.df, in_r.df);
  expect_as_in_r(t.p_value, in_r.p, "p");
  expect_as_in_r(t.effect_size, in_r.dz, "dz");
  // R's non-central t (Lenth 1989) says itself that it gives up digits in the far tail.
  EXPECT_NEAR(t.effect_interval.low, in_r.dz_low, 1e-9);
  EXPECT_NEAR(t.effect_interval.high, in_r.dz_high, 1e-9);
  const SignedRankTest w = wilcoxon_signed_rank(a, b);
  EXPECT_EQ(w.v, in_r.v);
  expect_as_in_r(w.p_value, in_r.v_p, "p of V");
  EXPECT_EQ(w.is_exact, in_r.is_exact);
  if (w.is_exact) {
    expect_as_in_r(w.shift, in_r.shift, "shift");
    expect_as_in_r(w.shift_interval->low, in_r.shift_low, "shift, low");
    expect_as_in_r(w.shift_interval->high, in_r.shift_high, "shift, high");
  } else {
    // R inverts the normal approximation there; ours stands at a Walsh average.
    const double range = in_r.shift_high - in_r.shift_low;
    EXPECT_NEAR(w.shift, in_r.shift, 0.03 * range);
    EXPECT_NEAR(w.shift_interval->low, in_r.shift_low, 0.05 * range);
    EXPECT_NEAR(w.shift_interval->high, in_r.shift_high, 0.05 * range);
  }
  const WelchTest u = welch_t_test(a, b);
  expect_as_in_r(u.t, in_r.welch_t, "Welch t");
  expect_as_in_r(u.df, in_r.welch_df, "Welch df");
  expect_as_in_r(u.p_value, in_r.welch_p, "Welch p");
  expect_as_in_r(u.interval.low, in_r.welch_low, "Welch low");
  expect_as_in_r(u.interval.high, in_r.welch_high, "Welch high");
}

TEST(PairedTests, EqualRWithAZeroAndATie) {
  // Student 1908, hours of sleep under two drugs.
  expect_paired({0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0, 2},
                {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4},
                {-1.5800000000000001,
                 -2.4598857632769824,
                 -0.70011423672301754,
                 -4.0621276833820366,
                 9,
                 0.0028328901973842702,
                 -1.2845575625910546,
                 -2.1180165139770675,
                 -0.41462775638014371,
                 0,
                 0.0090906980159250559,
                 false,
                 -1.4000306721873526,
                 -2.9499207995407808,
                 -1.0500179906645428,
                 -1.8608134674868531,
                 17.776473516178498,
                 0.079394140187358173,
                 -3.3654832307117104,
                 0.20548323071171018});
}

TEST(PairedTests, EqualROnDarwinsMaize) {
  // Fisher 1935, section 17: height of 15 pairs of plants.
  expect_paired(
      {23.5, 12, 21, 22, 19.125, 21.5, 22.125, 20.375, 18.25, 21.625, 23.25, 21, 22.125, 23, 12},
      {17.375, 20.375, 20, 20, 18.375, 18.625, 18.625, 15.25, 16.5, 18, 16.25, 18, 12.75, 15.5, 18},
      {2.6166666666666667,
       0.0038991647991217788,
       5.2294341685342109,
       2.1479874613311201,
       14,
       0.049702944021800928,
       0.55460797770651848,
       0.00070424870179276516,
       1.091602927801429,
       96,
       0.041259765625000007,
       true,
       3.125,
       0.5,
       5.1875,
       2.4371126507178857,
       22.164085588815993,
       0.023282559951189628,
       0.39095659197276117,
       4.8423767413605727});
}

TEST(PairedTests, EqualRWithNineAndWithThreePairs) {
  // Hollander & Wolfe 1973, p. 29: depression scale factor before and after.
  expect_paired({1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30},
                {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29},
                {0.43188888888888888,
                 0.10377871227216852,
                 0.75999906550560925,
                 3.0353754156485913,
                 8,
                 0.016176627434908095,
                 1.0117918052161969,
                 0.17714760906643437,
                 1.8071690619383318,
                 40,
                 0.0390625,
                 true,
                 0.46000000000000008,
                 0.010000000000000009,
                 0.78600000000000003,
                 1.2051727991066514,
                 15.795035582541246,
                 0.24588283853317081,
                 -0.3286079301898116,
                 1.192385707967589});
  const std::vector<double> a{1, 2.5, 4};
  const std::vector<double> b{0.5, 2.75, 3};
  const PairedTest t = paired_t_test(a, b);
  expect_as_in_r(t.p_value, 0.37005921165128797, "p");
  EXPECT_NEAR(t.effect_interval.low, -0.67431064396908025, 1e-9);
  EXPECT_NEAR(t.effect_interval.high, 1.8890075938319919, 1e-9);
  const SignedRankTest w = wilcoxon_signed_rank(a, b);
  EXPECT_EQ(w.v, 5.0);
  EXPECT_NEAR(w.p_value, 0.5, 1e-15);
  expect_as_in_r(w.shift, 0.4375, "shift");
  // Three pairs can't bound the shift at 95 %: even all eight signs leave 25 % outside.
  EXPECT_FALSE(w.shift_interval);
}

TEST(PairedTests, EqualROnBothSidesOfTheExactDistribution) {
  const auto cosine = [](double i) { return std::cos(i); };
  const auto sine = [](double i) { return std::sin(i) + 0.3; };
  expect_paired(series(49, sine), series(49, cosine),
                {0.32828310290893054,
                 0.039071419275519999,
                 0.61749478654234102,
                 2.2822640107654926,
                 48,
                 0.026946555977460148,
                 0.32603771582364183,
                 0.036975868641753458,
                 0.61187886301036676,
                 837,
                 0.024943301410257138,
                 true,
                 0.30752136448165984,
                 0.043377063596335863,
                 0.61960505477243211,
                 2.275133014377082,
                 95.949476564497431,
                 0.025123589850475116,
                 0.04186416215751268,
                 0.61470204366034831});
  expect_paired(series(50, sine), series(50, cosine),
                {0.30317062320683108,
                 0.015490565411050669,
                 0.59085068100261151,
                 2.1177838383708192,
                 49,
                 0.039291296415839297,
                 0.29949986263985623,
                 0.014618994334603229,
                 0.5814599486231713,
                 855,
                 0.036192201598523481,
                 false,
                 0.30158902389418829,
                 0.020933869626870195,
                 0.58657688022699017,
                 2.1222267100526362,
                 97.997880208169377,
                 0.03633972254093102,
                 0.019679517039265227,
                 0.58666172937439687});
}

TEST(PairedTests, EqualRWithTwoHundredPairsFarOut) {
  expect_paired(series(200, [](double i) { return 3700 + 80 * std::sin(i) + 20; }),
                series(200, [](double i) { return 3700 + 80 * std::cos(i * 1.7) - 30; }),
                {49.946889503786558,
                 38.692163799348833,
                 61.20161520822429,
                 8.7512657534759182,
                 199,
                 9.0174784086572781e-16,
                 0.61880793582484217,
                 0.46682738939671853,
                 0.76947268332827845,
                 16036,
                 2.807343730855492e-13,
                 false,
                 49.937384841675787,
                 38.171395120390329,
                 61.519477556422885,
                 8.8013129270985146,
                 397.99424463403108,
                 4.1766507426076349e-17,
                 38.790291713122201,
                 61.103487294451156});
}

TEST(PairedTests, EqualRWithManyTiesAndZeros) {
  expect_paired(series(60, [](double i) { return std::fmod(i * 7, 11); }),
                series(60, [](double i) { return std::fmod(i * 5, 13); }),
                {-0.98333333333333328,
                 -2.2862972518382922,
                 0.31963058517162557,
                 -1.5101304243158447,
                 59,
                 0.13634754367154134,
                 -0.19495699946588019,
                 -0.44960086787746267,
                 0.061305677263469902,
                 547.5,
                 0.13685152449712187,
                 false,
                 -1.0000504402429897,
                 -2.9999813759367506,
                 0.49994887629935114,
                 -1.5478155465935433,
                 114.680540708726,
                 0.12442196748688707,
                 -2.24178546412428,
                 0.27511879745761297});
}

TEST(PairedTests, SwappingTheSamplesTurnsTheSigns) {
  const auto a = series(30, [](double i) { return 0.3 + 0.05 * std::sin(i * i); });
  const auto b = series(30, [](double i) { return 0.28 + 0.05 * std::cos(i); });
  const PairedTest there = paired_t_test(a, b);
  const PairedTest back = paired_t_test(b, a);
  EXPECT_EQ(there.t, -back.t);
  EXPECT_EQ(there.p_value, back.p_value);
  EXPECT_NEAR(there.effect_interval.low, -back.effect_interval.high, 1e-12);
  const SignedRankTest w = wilcoxon_signed_rank(a, b);
  const SignedRankTest r = wilcoxon_signed_rank(b, a);
  EXPECT_EQ(w.rank_biserial, -r.rank_biserial);
  EXPECT_EQ(w.p_value, r.p_value);
  EXPECT_NEAR(w.shift, -r.shift, 1e-15);
}

TEST(PairedTests, OneSidedDifferencesReachRankBiserialOne) {
  const SignedRankTest w =
      wilcoxon_signed_rank(std::vector<double>{2, 4, 7, 11}, std::vector<double>{1, 1, 1, 1});
  EXPECT_EQ(w.rank_biserial, 1.0);
  EXPECT_EQ(w.p_value, 0.125);  // 2 / 2^4
}

TEST(PairedTest, HugeEffectsStillHaveAnInterval) {
  // t of about 5e4, where the series of non-central t don't reach. With n = 200 the interval of dz
  // is close to dz -/+ 1.96 sqrt(1/n + dz^2 / (2 n)) (Hedges & Olkin 1985, equation 21).
  const auto a = series(200, [](double i) { return 1000 + 0.3 * std::sin(i); });
  const auto b = series(200, [](double) { return 0.0; });
  const PairedTest t = paired_t_test(a, b);
  const double half = 1.96 * std::sqrt(1.0 / 200 + t.effect_size * t.effect_size / 400);
  EXPECT_NEAR(t.effect_interval.low, t.effect_size - half, 0.02 * t.effect_size);
  EXPECT_NEAR(t.effect_interval.high, t.effect_size + half, 0.02 * t.effect_size);
}

TEST(PairedTests, EqualSamplesHaveAStatusAndNoNan) {
  const std::vector<double> a{1.0, 2.0, 3.0};
  const PairedTest same = paired_t_test(a, a);
  EXPECT_TRUE(same.is_constant);
  EXPECT_EQ(same.p_value, 1.0);
  EXPECT_EQ(same.t, 0.0);
  const PairedTest shifted = paired_t_test(std::vector<double>{1.1, 2.1, 3.1}, a);
  EXPECT_TRUE(shifted.is_constant);  // 0.1 but for rounding
  EXPECT_NEAR(shifted.interval.low, 0.1, 1e-15);
  const SignedRankTest w = wilcoxon_signed_rank(a, a);
  EXPECT_TRUE(w.is_constant);
  EXPECT_EQ(w.n_used, 0);
  EXPECT_EQ(w.p_value, 1.0);
  EXPECT_FALSE(w.shift_interval);
  const std::vector<double> flat(5, 2.0);
  EXPECT_TRUE(welch_t_test(flat, std::vector<double>{3.0, 3.0}).is_constant);
}

TEST(PairedTests, BadInputIsNamed) {
  const std::vector<double> two{1, 2};
  const std::vector<double> three{1, 2, 4};
  EXPECT_THAT(usage_error([&] { paired_t_test(two, three); }), HasSubstr("2 and 3 values"));
  EXPECT_THAT(usage_error([&] { paired_t_test({}, {}); }), HasSubstr("0 values; at least 2"));
  EXPECT_THAT(usage_error([&] { wilcoxon_signed_rank({}, {}); }), HasSubstr("0 values"));
  EXPECT_THAT(usage_error([&] {
                paired_t_test(two, std::vector<double>{1, NAN});
              }),
              HasSubstr("second sample: value 2 is not a finite number"));
  EXPECT_THAT(usage_error([&] { paired_t_test(two, two, 1.0); }), HasSubstr("confidence level"));
  EXPECT_THAT(usage_error([&] { welch_t_test(std::vector<double>{1}, two); }),
              HasSubstr("first sample: 1 value; at least 2 are needed"));
}

// R 4.2.2, tests/r/paired_tests.R: p.adjust(method = "holm").
TEST(Holm, EqualsR) {
  const std::vector<double> adjusted =
      holm(std::vector<double>{0.01, 0.04, 0.03, 0.005, 0.5, 0.04});
  const std::vector<double> in_r{0.05, 0.12, 0.12, 0.03, 0.5, 0.12};
  for (std::size_t i = 0; i < in_r.size(); ++i) expect_as_in_r(adjusted[i], in_r[i], "p");
  EXPECT_THAT(holm(std::vector<double>{0.9, 0.8}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(holm({}).empty());
  EXPECT_THAT(usage_error([] {
                holm(std::vector<double>{0.1, 1.5});
              }),
              HasSubstr("p value 2 is 1.5"));
}

TEST(WalshAverages, AreTheSortedAveragesOfAllPairs) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<double> x;
    for (int i = 0; i < 1 + round; ++i) {
      x.push_back(static_cast<double>(static_cast<int>(random() % 41)) / 8.0 - 2.5);
    }
    std::sort(x.begin(), x.end());
    std::vector<double> all;
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = i; j < x.size(); ++j) all.push_back(0.5 * x[i] + 0.5 * x[j]);
    }
    std::sort(all.begin(), all.end());
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(walsh_average(x, k + 1), all[k]);
    const double median = all.size() % 2 == 1
                              ? all[all.size() / 2]
                              : 0.5 * (all[all.size() / 2 - 1] + all[all.size() / 2]);
    EXPECT_EQ(walsh_median(x), median);
  }
}

TEST(SignedRankCounts, AreThoseOfSubsets) {
  // {1, 2, 3}: sums 0 1 2 3 3 4 5 6.
  EXPECT_THAT(signed_rank_counts(3), ElementsAre(1, 1, 1, 2, 1, 1, 1));
  double sum = 0.0;
  for (const double c : signed_rank_counts(49)) sum += c;
  EXPECT_EQ(sum, std::ldexp(1.0, 49));
}

}  // namespace
}  // namespace palmar::statistics
