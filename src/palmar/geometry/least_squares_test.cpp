// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Misra1a of the Statistical Reference Datasets (NIST, StRD, nonlinear regression): dental
/// research, volume over pressure, y = b1 (1 - exp(-b2 x)).
constexpr std::array<double, 14> kMisraY = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                                            44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
constexpr std::array<double, 14> kMisraX = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                                            378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};

LeastSquaresProblem misra() {
  return {[](const VectorXd& b, VectorXd& r, MatrixXd* jacobian) {
            r.resize(14);
            if (jacobian != nullptr) jacobian->resize(14, 2);
            for (Eigen::Index i = 0; i < 14; ++i) {
              const double x = kMisraX[i];
              const double fading = std::exp(-b[1] * x);
              r[i] = b[0] * (1.0 - fading) - kMisraY[i];
              if (jacobian == nullptr) continue;
              (*jacobian)(i, 0) = 1.0 - fading;
              (*jacobian)(i, 1) = b[0] * x * fading;
            }
          },
          VectorXd{{1.0, 1e-6}}, VectorXd{{1e4, 1.0}}};
}

LeastSquaresProblem rosenbrock(VectorXd lower, VectorXd upper) {
  return {[](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
            r = VectorXd{{10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]}};
            if (jacobian != nullptr) *jacobian = MatrixXd{{-20.0 * x[0], 10.0}, {-1.0, 0.0}};
          },
          std::move(lower), std::move(upper)};
}

TEST(LeastSquares, MeetsTheCertifiedFitOfMisraFromBothStarts) {
  for (const VectorXd& start : {VectorXd{{500.0, 0.0001}}, VectorXd{{250.0, 0.0005}}}) {
    const LeastSquaresSolution fit = solve_least_squares(misra(), start);
    EXPECT_EQ(fit.status, LeastSquaresStatus::kConverged);
    EXPECT_NEAR(fit.x[0], 2.3894212918e+02, 1e-6 * 239);  // certified, 11 digits
    EXPECT_NEAR(fit.x[1], 5.5015643181e-04, 1e-6 * 5.5e-4);
    EXPECT_NEAR(fit.sum_of_squares, 1.2455138894e-01, 1e-8);
    // Certified standard deviations of the estimates.
    const double variance = fit.sum_of_squares / 12;
    const MatrixXd covariance =
        variance * MatrixXd(fit.jacobian.transpose() * fit.jacobian).inverse();
    EXPECT_NEAR(std::sqrt(covariance(0, 0)), 2.7070075241, 1e-4);
    EXPECT_NEAR(std::sqrt(covariance(1, 1)), 7.2668688436e-06, 1e-10);
  }
}

TEST(LeastSquares, WalksTheCurvedValleyOfRosenbrock) {
  const LeastSquaresSolution fit = solve_least_squares(
      rosenbrock(VectorXd{{-5.0, -5.0}}, VectorXd{{5.0, 5.0}}), VectorXd{{-1.2, 1.0}});
  EXPECT_NEAR(fit.x[0], 1.0, 1e-8);
  EXPECT_NEAR(fit.x[1], 1.0, 1e-8);
  EXPECT_LT(fit.iterations, 100);
}

TEST(LeastSquares, StopsAtTheWallWhereTheGradientHoldsIt) {
  // x0 <= 1/2: the least value is on the wall, at x1 = x0^2, with sum (1 - x0)^2 = 1/4.
  const LeastSquaresSolution fit = solve_least_squares(
      rosenbrock(VectorXd{{-5.0, -5.0}}, VectorXd{{0.5, 5.0}}), VectorXd{{-1.2, 1.0}});
  EXPECT_EQ(fit.x[0], 0.5);
  EXPECT_NEAR(fit.x[1], 0.25, 1e-8);
  EXPECT_NEAR(fit.sum_of_squares, 0.25, 1e-12);
  EXPECT_TRUE(fit.at_bound[0]);
  EXPECT_FALSE(fit.at_bound[1]);
}

TEST(LeastSquares, AStartOutsideTheBoxIsBroughtIn) {
  const LeastSquaresSolution fit = solve_least_squares(misra(), VectorXd{{1e9, -4.0}});
  EXPECT_NEAR(fit.x[0], 2.3894212918e+02, 1e-4);
}

TEST(LeastSquares, AVariableThatMattersNothingStaysWhereItWas) {
  LeastSquaresProblem problem{[](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
                                r = VectorXd{{x[0] - 3.0, 2.0 * x[0] - 5.0}};
                                if (jacobian != nullptr) {
                                  *jacobian = MatrixXd{{1.0, 0.0}, {2.0, 0.0}};
                                }
                              },
                              VectorXd{{-10.0, -10.0}}, VectorXd{{10.0, 10.0}}};
  const LeastSquaresSolution fit = solve_least_squares(problem, VectorXd{{0.0, 4.0}});
  EXPECT_EQ(fit.status, LeastSquaresStatus::kConverged);
  EXPECT_NEAR(fit.x[0], 13.0 / 5.0, 1e-9);  // (1*3 + 2*5) / (1 + 4)
  EXPECT_EQ(fit.x[1], 4.0);
}

TEST(LeastSquares, FailuresAreStatuses) {
  LeastSquaresOptions two;
  two.max_iterations = 2;
  EXPECT_EQ(solve_least_squares(misra(), VectorXd{{500.0, 0.0001}}, two).status,
            LeastSquaresStatus::kIterationLimit);
  LeastSquaresProblem broken = misra();
  broken.evaluate = [](const VectorXd&, VectorXd& r, MatrixXd* jacobian) {
    r = VectorXd{{std::nan("")}};
    if (jacobian != nullptr) *jacobian = MatrixXd::Zero(1, 2);
  };
  EXPECT_EQ(solve_least_squares(broken, VectorXd{{1.0, 1.0}}).status,
            LeastSquaresStatus::kBadStart);
  EXPECT_THROW(solve_least_squares(misra(), VectorXd{{1.0}}), UsageError);
}

}  // namespace
}  // namespace palmar::geometry
