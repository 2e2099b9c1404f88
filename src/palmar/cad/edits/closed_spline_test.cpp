// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/closed_spline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Points of r(phi) = 20 + wave cos(k phi).
Eigen::MatrixXd flower(int points, double wave, int k) {
  Eigen::MatrixXd rows(points, 2);
  for (int i = 0; i < points; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / points;
    const double r = 20.0 + wave * std::cos(k * phi);
    rows.row(i) << r * std::cos(phi), r * std::sin(phi);
  }
  return rows;
}

TEST(ClosedSpline, TakesNoMorePolesThanItNeeds) {
  const ClosedSpline circle = fit_closed_spline(flower(120, 0.0, 1), 0.1);
  EXPECT_EQ(circle.poles.rows(), 8);
  EXPECT_LT(circle.deviation, 0.1);
  // Cubic B-splines with one pole per angle h are off a circle by about r h^4 / 384.
  const double h = 2.0 * std::numbers::pi / 8;
  EXPECT_LT(circle.deviation, 20.0 * std::pow(h, 4) / 384.0);
  const ClosedSpline waves = fit_closed_spline(flower(240, 2.0, 5), 0.1);
  EXPECT_GT(waves.poles.rows(), 10);
  EXPECT_LE(waves.poles.rows(), 40);
  EXPECT_LT(waves.deviation, 0.1);
}

TEST(ClosedSpline, NeverHasMoreThanTheMostAndSaysHowFarItIsOff) {
  const ClosedSpline rough = fit_closed_spline(flower(600, 2.0, 40), 0.1);
  EXPECT_EQ(rough.poles.rows(), 40);
  EXPECT_GT(rough.deviation, 0.5);  // 40 waves need more
  EXPECT_EQ(fit_closed_spline(flower(12, 0.0, 1), 1e-9).poles.rows(), 6);
}

TEST(ClosedSpline, ThreePointsAreNone) {
  EXPECT_THAT([] { fit_closed_spline(flower(3, 0.0, 1), 0.1); },
              ThrowsMessage<UsageError>(HasSubstr("3 points; at least 4")));
}

}  // namespace
}  // namespace palmar::cad
