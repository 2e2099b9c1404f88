// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/correlation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/statistics/statistics_test_data.h"

namespace palmar::statistics {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct InR {
  double r, t, df, p, low, high, rho, rho_p;
};

void expect_equals(const std::vector<double>& x, const std::vector<double>& y, const InR& in_r) {
  const Correlation c = pearson(x, y);
  EXPECT_EQ(c.n, static_cast<int>(x.size()));
  expect_as_in_r(c.r, in_r.r, "r");
  expect_as_in_r(c.t, in_r.t, "t");
  EXPECT_EQ(c.df, in_r.df);
  expect_as_in_r(c.p_value, in_r.p, "p");
  expect_as_in_r(c.interval->low, in_r.low, "low");
  expect_as_in_r(c.interval->high, in_r.high, "high");
  const Correlation s = spearman(x, y);
  expect_as_in_r(s.r, in_r.rho, "rho");
  expect_as_in_r(s.p_value, in_r.rho_p, "p of rho");
}

// R 4.2.2, tests/r/correlation.R: cor.test().
TEST(Correlation, EqualsR) {
  expect_equals(
      {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5},
      {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68},
      {0.81642051634483992, 4.2414552888928325, 9, 0.0021696288730787918, 0.42439121339321656,
       0.95069325378656055, 0.81818181818181823, 0.0020831448404786904});
  expect_equals(
      {181, 193, 176, 188, 201, 169, 184}, {190, 201, 187, 186, 209, 178, 198},
      {0.89090644987172984, 4.3861405711703281, 5, 0.0071135459020626787, 0.41887010895478294,
       0.98387713342222161, 0.78571428571428548, 0.048015873015873019});
  expect_equals(
      {1, 2, 3, 5}, {2, 1, 4, 3.5},
      {0.65561216854295901, 1.2278881264599484, 2, 0.34438783145704088, -0.82583193588269144,
       0.99177895093776613, 0.60000000000000009, 0.41666666666666669});
}

TEST(Correlation, EqualsRWhereItFallsAndTheTailIsFarOut) {
  expect_equals(
      series(200, [](double i) { return 190 + 10 * std::sin(i); }),
      series(200, [](double i) { return 200 - 6 * std::sin(i) + 8 * std::cos(i * 1.3); }),
      {-0.61582619024520457, -10.998401033265498, 198, 2.880269601832108e-22, -0.69517150793363169,
       -0.52165561367704827, -0.57249981249531245, 8.2433142523529792e-19});
}

TEST(Correlation, EqualsRWithTies) {
  const auto step = [](double i) { return std::fmod(i * 7, 23); };
  expect_equals(
      series(60, [&](double i) { return 180 + step(i); }),
      series(60, [&](double i) { return 195 + std::floor(step(i) / 2) + std::fmod(i * 5, 11); }),
      {0.74388546267328515, 8.4770349682274784, 58, 9.76781720176776e-12, 0.60406270511012983,
       0.83927816210867778, 0.73504900858708011, 2.2799129360930243e-11});
}

TEST(Correlation, IsTheSameInOtherUnitsAndTurnsWithTheSign) {
  const auto x = series(30, [](double i) { return 180 + 9 * std::sin(i); });
  const auto y = series(30, [](double i) { return 190 + 7 * std::sin(i + 0.8); });
  const auto inches = series(30, [&](double i) { return x[i - 1] / 25.4; });
  const auto turned = series(30, [&](double i) { return -y[i - 1]; });
  EXPECT_NEAR(pearson(inches, y).r, pearson(x, y).r, 1e-14);
  EXPECT_NEAR(pearson(x, turned).r, -pearson(x, y).r, 1e-14);
  EXPECT_EQ(pearson(x, y).r, pearson(y, x).r);
}

TEST(Correlation, ConstantAndExactDataHaveAStatusAndNoNan) {
  const std::vector<double> x{1, 2, 3, 4, 5};
  const Correlation constant = pearson(x, std::vector<double>(5, 7.0));
  EXPECT_EQ(constant.status, CorrelationStatus::kConstant);
  EXPECT_EQ(constant.r, 0.0);
  EXPECT_EQ(constant.p_value, 1.0);
  EXPECT_FALSE(constant.interval);
  const Correlation exact = pearson(x, std::vector<double>{-2, -4, -6, -8, -10});
  EXPECT_EQ(exact.status, CorrelationStatus::kExact);
  EXPECT_EQ(exact.r, -1.0);
  EXPECT_EQ(exact.p_value, 0.0);
  EXPECT_EQ(exact.interval->low, -1.0);
  EXPECT_FALSE(pearson(std::vector<double>{1, 2, 3}, std::vector<double>{1, 3, 2}).interval);
}

TEST(Correlation, BadInputIsNamed) {
  const std::vector<double> two{1, 2};
  const std::vector<double> three{1, 2, 4};
  EXPECT_THAT(usage_error([&] { pearson(two, three); }), HasSubstr("2 and 3 values"));
  EXPECT_THAT(usage_error([&] { pearson(two, two); }), HasSubstr("2 values; at least 3"));
  EXPECT_THAT(usage_error([&] {
                pearson(three, std::vector<double>{1, INFINITY, 2});
              }),
              HasSubstr("correlation, y: value 2"));
}

TEST(MeanRanks, TiesShareTheirRank) {
  EXPECT_THAT(mean_ranks(std::vector<double>{10, 30, 20, 30}), ElementsAre(1, 3.5, 2, 3.5));
}

TEST(CompletePairs, LeavesOutWhatIsMissingOnEitherSide) {
  const std::vector<std::optional<double>> x{1.0, std::nullopt, 3.0, 4.0};
  const std::vector<std::optional<double>> y{5.0, 6.0, std::nullopt, 8.0};
  const auto [a, b] = complete_pairs(x, y);
  EXPECT_THAT(a, ElementsAre(1.0, 4.0));
  EXPECT_THAT(b, ElementsAre(5.0, 8.0));
}

}  // namespace
}  // namespace palmar::statistics
