// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/linear_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/statistics/statistics_test_data.h"

namespace palmar::statistics {
namespace {

using testing::HasSubstr;

void expect_coefficient(const Coefficient& c, double estimate, double error, double t, double p) {
  expect_as_in_r(c.estimate, estimate, "estimate");
  expect_as_in_r(c.standard_error, error, "standard error");
  expect_as_in_r(c.t, t, "t");
  expect_as_in_r(c.p_value, p, "p");
}

void expect_whole(const LinearFit& fit, double r2, double adjusted, double sigma, double f,
                  double p) {
  EXPECT_EQ(fit.status, FitStatus::kFitted);
  expect_as_in_r(fit.r2, r2, "R2");
  expect_as_in_r(fit.adjusted_r2, adjusted, "adjusted R2");
  expect_as_in_r(fit.residual_sd, sigma, "residual sd");
  expect_as_in_r(fit.f, f, "F");
  expect_as_in_r(fit.f_p_value, p, "p of F");
}

void expect_band(const Band& band, double value, double low, double high) {
  expect_as_in_r(band.value, value, "value");
  expect_as_in_r(band.low, low, "low");
  expect_as_in_r(band.high, high, "high");
}

// All figures: R 4.2.2, tests/r/linear_fit.R, summary(lm()) and predict().
TEST(LinearFit, EqualsR) {
  const LinearFit fit = fit_line(kCarSpeed, kCarDistance);
  expect_coefficient(fit.intercept, -17.579094890510895, 6.7584401693792335, -2.6010580030222483,
                     0.012318816153809031);
  expect_coefficient(fit.slopes[0], 3.9324087591240855, 0.41551277665712222, 9.4639899902983675,
                     1.4898364962950928e-12);
  expect_whole(fit, 0.65107938075825089, 0.64381020119071453, 15.379586748819907,
               89.567106536467719, 1.4898364962950928e-12);
  EXPECT_EQ(fit.n, 50);
  EXPECT_EQ(fit.df, 48);
  expect_band(confidence_band(fit, 21.0), 65.001489051094893, 58.597383784697207,
              71.405594317492586);
  expect_band(prediction_band(fit, 21.0, 0.99), 65.001489051094893, 22.874944804343698,
              107.12803329784609);
}

TEST(LinearFit, EqualsRWithTwoPredictors) {
  // Motor Trend 1974 (Henderson & Velleman 1981; R's `mtcars`): weight and power.
  const std::vector<double> mpg{21,   21,   22.8, 21.4, 18.7, 18.1, 14.3, 24.4, 22.8, 19.2, 17.8,
                                16.4, 17.3, 15.2, 10.4, 10.4, 14.7, 32.4, 30.4, 33.9, 21.5, 15.5,
                                15.2, 13.3, 19.2, 27.3, 26,   30.4, 15.8, 19.7, 15,   21.4};
  const std::vector<double> wt{2.62,  2.875, 2.32,  3.215, 3.44,  3.46, 3.57,  3.19,
                               3.15,  3.44,  3.44,  4.07,  3.73,  3.78, 5.25,  5.424,
                               5.345, 2.2,   1.615, 1.835, 2.465, 3.52, 3.435, 3.84,
                               3.845, 1.935, 2.14,  1.513, 3.17,  2.77, 3.57,  2.78};
  const std::vector<double> hp{110, 110, 93,  110, 175, 105, 245, 62,  95,  123, 123,
                               180, 180, 180, 205, 215, 230, 66,  52,  65,  97,  150,
                               150, 245, 175, 66,  91,  113, 264, 175, 335, 109};
  Eigen::MatrixXd x(32, 2);
  for (int i = 0; i < 32; ++i) {
    x.row(i) << wt[i], hp[i];
  }
  const LinearFit fit = fit_linear(x, mpg);
  expect_coefficient(fit.intercept, 37.227270116447201, 1.5987875379993941, 23.284688697930861,
                     2.5654585119837577e-20);
  expect_coefficient(fit.slopes[0], -3.8778307424046821, 0.63273349437739534, -6.1286952198104139,
                     1.1196471362000422e-06);
  expect_coefficient(fit.slopes[1], -0.031772946982161002, 0.0090297096758557224,
                     -3.5187119102087809, 0.0014512285315694238);
  expect_whole(fit, 0.82678545188279118, 0.8148396209781561, 2.5934117772265668, 69.211213391777648,
               9.1090543852220887e-12);
  const Eigen::VectorXd at = Eigen::Vector2d(3.0, 120.0);
  expect_band(confidence_band(fit, at), 21.781024251373836, 20.771780107382625, 22.790268395365047);
  expect_band(prediction_band(fit, at, 0.99), 21.781024251373836, 14.504327357747066,
              29.057721145000606);
}

TEST(LinearFit, EqualsRWherePredictorsAreNearlyDependent) {
  // Longley 1967; the coefficients agree with those that NIST certifies (StRD).
  Eigen::MatrixXd x(16, 6);
  x << 83, 234.289, 235.6, 159, 107.608, 1947,  //
      88.5, 259.426, 232.5, 145.6, 108.632, 1948, 88.2, 258.054, 368.2, 161.6, 109.773, 1949, 89.5,
      284.599, 335.1, 165, 110.929, 1950, 96.2, 328.975, 209.9, 309.9, 112.075, 1951, 98.1, 346.999,
      193.2, 359.4, 113.27, 1952, 99, 365.385, 187, 354.7, 115.094, 1953, 100, 363.112, 357.8, 335,
      116.219, 1954, 101.2, 397.469, 290.4, 304.8, 117.388, 1955, 104.6, 419.18, 282.2, 285.7,
      118.734, 1956, 108.4, 442.769, 293.6, 279.8, 120.445, 1957, 110.8, 444.546, 468.1, 263.7,
      121.95, 1958, 112.6, 482.704, 381.3, 255.2, 123.366, 1959, 114.2, 502.601, 393.1, 251.4,
      125.368, 1960, 115.7, 518.173, 480.6, 257.2, 127.852, 1961, 116.9, 554.894, 400.7, 282.7,
      130.081, 1962;
  const std::vector<double> y{60.323, 61.122, 60.171, 61.187, 63.221, 63.639, 64.989, 63.761,
                              66.019, 67.857, 68.169, 66.513, 68.655, 69.564, 69.331, 70.551};
  const LinearFit fit = fit_linear(x, y);
  expect_coefficient(fit.intercept, -3482.2586345958148, 890.4203836073757, -3.9108029181543209,
                     0.0035604036637263241);
  expect_coefficient(fit.slopes[0], 0.015061872271372779, 0.084914925774767377, 0.1773760282299916,
                     0.86314083280921983);
  expect_coefficient(fit.slopes[5], 1.8291514646135503, 0.45547849914221344, 4.0158898127097693,
                     0.0030368033416303623);
  expect_whole(fit, 0.99547900457729555, 0.99246500762882595, 0.3048540735619657,
               330.28533923458622, 4.9840305287249179e-10);
  Eigen::VectorXd at(6);
  at << 100, 400, 300, 250, 117, 1955;
  expect_band(confidence_band(fit, at), 66.28805729292344, 65.336845461148471, 67.23926912469841);
  expect_band(prediction_band(fit, at, 0.99), 66.28805729292344, 64.600184981948757,
              67.975929603898123);
}

TEST(LinearFit, EqualsRWhereItFallsAndTheTailIsFarOut) {
  const auto x = series(200, [](double i) { return 190 + 10 * std::sin(i); });
  const auto y = series(
      200, [](double i) { return 260 - 0.31 * (190 + 10 * std::sin(i)) + 2 * std::cos(i * 1.3); });
  const LinearFit fit = fit_line(x, y);
  expect_coefficient(fit.slopes[0], -0.31562237555288114, 0.014149545473218251, -22.306184756978929,
                     6.3578202137262449e-56);
  EXPECT_NEAR(fit.intercept.p_value / 6.5697631178941663e-169, 1.0, 1e-9);
  expect_band(confidence_band(fit, 240.0), 185.31473323352901, 183.90566680450786,
              186.72379966255016);
}

TEST(LinearFit, EqualsRWithThreePoints) {
  const LinearFit fit = fit_line(std::vector<double>{1, 2, 4}, std::vector<double>{1, 2, 2.5});
  expect_coefficient(fit.slopes[0], 0.46428571428571419, 0.18557687223952254, 2.501851166488378,
                     0.24207543664735345);
  expect_band(prediction_band(fit, 3.0, 0.99), 2.1428571428571428, -28.358742957062081,
              32.644457242776369);
}

TEST(LinearFit, ExactAndConstantDataHaveAStatusAndNoNan) {
  const std::vector<double> x{180, 185, 190, 200};
  const LinearFit exact = fit_line(x, std::vector<double>{92, 94.5, 97, 102});
  EXPECT_EQ(exact.status, FitStatus::kExact);
  EXPECT_NEAR(exact.slopes[0].estimate, 0.5, 1e-13);
  EXPECT_NEAR(exact.intercept.estimate, 2.0, 1e-10);
  EXPECT_EQ(exact.r2, 1.0);
  EXPECT_EQ(exact.slopes[0].p_value, 0.0);
  EXPECT_EQ(prediction_band(exact, 188.0).low, prediction_band(exact, 188.0).high);
  const LinearFit constant = fit_line(x, std::vector<double>(4, 0.1));
  EXPECT_EQ(constant.status, FitStatus::kConstantY);
  EXPECT_EQ(constant.slopes[0].estimate, 0.0);
  EXPECT_EQ(constant.slopes[0].p_value, 1.0);
  EXPECT_EQ(constant.f_p_value, 1.0);
  EXPECT_NEAR(confidence_band(constant, 300.0).value, 0.1, 1e-16);
}

TEST(LinearFit, BadInputIsNamed) {
  const std::vector<double> x{1, 2, 3, 4};
  EXPECT_THAT(usage_error([&] {
                fit_line(x, std::vector<double>{1, 2});
              }),
              HasSubstr("4 values of x and 2 of y"));
  EXPECT_THAT(usage_error([&] { fit_line(std::vector<double>(4, 3.0), x); }),
              HasSubstr("x is 3.000000 throughout"));
  EXPECT_THAT(usage_error([&] {
                fit_line(std::vector<double>{1, 2}, std::vector<double>{1, 2});
              }),
              HasSubstr("2 values; at least 3"));
  Eigen::MatrixXd dependent(5, 2);
  dependent << 1, 2, 2, 4, 3, 6, 4, 8, 6, 12;
  EXPECT_THAT(usage_error([&] {
                fit_linear(dependent, std::vector<double>{1, 2, 2, 3, 5}, {"length", "width"});
              }),
              testing::AnyOf(HasSubstr("length is a linear function"),
                             HasSubstr("width is a linear function")));
  const LinearFit fit = fit_line(x, std::vector<double>{1, 3, 2, 5});
  EXPECT_THAT(usage_error([&] { confidence_band(fit, Eigen::VectorXd(Eigen::Vector2d(1, 2))); }),
              HasSubstr("point of 2 numbers; the fit has 1"));
}

}  // namespace
}  // namespace palmar::statistics
