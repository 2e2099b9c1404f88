// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

constexpr double kPi = std::numbers::pi;

PressOptions sphere_on_plane(double radius, double spacing) {
  PressOptions options;
  options.indenter = {PressIndenter::Kind::kSphere, radius};
  options.shear_modulus = 0.05;  // MPa
  options.spacing = spacing;
  options.depths = {2.0};
  return options;
}

TEST(Press, SphereOnHalfSpaceMeetsHertz) {
  // Case G1: R = 20 mm, G = 50 kPa, nu = 0.5; F = (16/3) G sqrt(R) depth^1.5.
  const double force[] = {0.4216, 1.1926, 3.3731};  // N at 0.5, 1, 2 mm
  for (const double spacing : {2.5, 1.25, 0.8}) {
    PressOptions options = sphere_on_plane(20.0, spacing);
    options.depths = {0.5, 1.0, 2.0};
    const std::vector<PressStep> steps = press(options);
    ASSERT_EQ(steps.size(), 3U);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(steps[i].force, force[i], 0.02 * force[i]) << spacing << " mm";
      const double area = kPi * 20.0 * options.depths[i];
      EXPECT_NEAR(steps[i].area, area, 0.10 * area) << spacing << " mm";
      EXPECT_LT(steps[i].relative_residual, 1e-9);
    }
    EXPECT_NEAR(steps[2].peak_pressure, 0.04026, 0.05 * 0.04026);  // MPa
    EXPECT_NEAR(steps[2].peak_pressure / steps[2].mean_pressure, 1.5, 0.1);
    EXPECT_LT(steps[2].peak_pressure_cells, steps[2].peak_pressure);
  }
}

TEST(Press, FineLatticeMeetsHertzToHalfAPercent) {
  const PressStep step = press(sphere_on_plane(20.0, std::sqrt(40.0) / 10.0)).front();
  EXPECT_NEAR(step.force, 3.3731, 0.005 * 3.3731);
}

TEST(Press, FlatPunchHasTheStiffnessOfTheClosedForm) {
  // F = 8 G a depth = 2 N per mm for a = 5 mm, G = 50 kPa.
  for (const double spacing : {2.5, 0.5}) {
    PressOptions options = sphere_on_plane(5.0, spacing);
    options.indenter.kind = PressIndenter::Kind::kPunch;
    options.depths = {1.0};
    const PressStep step = press(options).front();
    EXPECT_NEAR(step.force, 2.0, 0.005 * 2.0) << spacing << " mm";
    EXPECT_NEAR(step.area, 25.0 * kPi, 0.01 * 25.0 * kPi);
  }
}

TEST(Press, EllipticContactMeetsTheClosedForm) {
  // Closed form from a chosen ellipse a = 4, b = 2 mm (Johnson 1985, section 4.2): with
  // e^2 = 1 - b^2 / a^2,
  //   depth = (p0 / E*) b K,   1 / R_x = 2 (p0 / E*) b (K - E) / (e^2 a^2),
  //   1 / R_y = 2 (p0 / E*) b ((a / b)^2 E - K) / (e^2 a^2),   F = (2/3) pi a b p0.
  const double a = 4.0;
  const double b = 2.0;
  const double shear_modulus = 0.05;
  const double p0 = 0.03;  // MPa
  const double ratio = p0 / (4.0 * shear_modulus);
  const double e = std::sqrt(1.0 - b * b / (a * a));
  const double K = std::comp_ellint_1(e);
  const double E = std::comp_ellint_2(e);
  PressOptions options;
  options.specimen.kind = PressSpecimen::Kind::kEllipsoid;
  options.specimen.radius_x = e * e * a * a / (2.0 * ratio * b * (K - E));
  options.specimen.radius_y = e * e * a * a / (2.0 * ratio * b * (a * a / (b * b) * E - K));
  options.indenter.kind = PressIndenter::Kind::kPlane;
  options.shear_modulus = shear_modulus;
  options.spacing = 0.8;
  options.depths = {ratio * b * K};
  const PressStep step = press(options).front();
  const double force = 2.0 / 3.0 * kPi * a * b * p0;
  EXPECT_NEAR(step.force, force, 0.01 * force);
  EXPECT_NEAR(step.area, kPi * a * b, 0.05 * kPi * a * b);
  EXPECT_NEAR(step.peak_pressure, p0, 0.02 * p0);
}

TEST(Press, PlateOnABallIsTheSameAsABallOnAPlane) {
  PressOptions options = sphere_on_plane(12.0, 1.0);
  const PressStep ball_on_plane = press(options).front();
  options.specimen.kind = PressSpecimen::Kind::kEllipsoid;
  options.specimen.radius_x = 12.0;
  options.specimen.radius_y = 12.0;
  options.indenter.kind = PressIndenter::Kind::kPlane;
  options.tilt = 0.5;  // a ball has no side
  const PressStep plate_on_ball = press(options).front();
  EXPECT_NEAR(plate_on_ball.force, ball_on_plane.force, 1e-6 * ball_on_plane.force);
}

TEST(Press, ScalingAllLengthsScalesForceBySquareAndKeepsPressure) {
  const PressStep small = press(sphere_on_plane(10.0, 0.5)).front();
  PressOptions options = sphere_on_plane(30.0, 1.5);
  options.depths = {6.0};
  const PressStep large = press(options).front();
  EXPECT_NEAR(large.force, 9.0 * small.force, 1e-9 * large.force);
  EXPECT_NEAR(large.peak_pressure, small.peak_pressure, 1e-9 * small.peak_pressure);
}

TEST(Press, ForceControlFindsTheDepth) {
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.depths.clear();
  options.forces = {1.1926};
  const PressStep step = press(options).front();
  EXPECT_NEAR(step.force, 1.1926, 0.002 * 1.1926);
  EXPECT_NEAR(step.depth, 1.0, 0.01);
}

TEST(Press, AreaDoesNotDependOnTheShearModulus) {
  PressOptions options = sphere_on_plane(20.0, 1.25);
  const PressStep soft = press(options).front();
  options.shear_modulus = 0.2;
  const PressStep stiff = press(options).front();
  EXPECT_NEAR(stiff.area, soft.area, 1e-9);
  EXPECT_NEAR(stiff.force, 4.0 * soft.force, 1e-9 * stiff.force);
}

TEST(Press, HandRegionPressedByAPlateMeetsHertz) {
  // A ball of skin of R = 20 mm; edges of 1.4 mm, contact radius 6.3 mm.
  const PreparedHand hand(contact_test::ball_hand(20.0, 4));
  PressOptions options = sphere_on_plane(1.0, 1.0);
  options.specimen.kind = PressSpecimen::Kind::kHandRegion;
  options.indenter.kind = PressIndenter::Kind::kPlane;
  const PressStep step = press(options, &hand).front();
  EXPECT_NEAR(step.force, 3.3731, 0.03 * 3.3731);
  EXPECT_NEAR(step.area, kPi * 40.0, 0.10 * kPi * 40.0);
}

TEST(Press, RefusesWhatItCannotDo) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.layer_thickness = 0.0;
  EXPECT_THAT([&] { press(options); },
              ThrowsMessage<UsageError>(HasSubstr("thickness of the layer is 0 mm")));
  options = sphere_on_plane(20.0, 1.25);
  options.depths = {-1.0};
  EXPECT_THAT([&] { press(options); }, ThrowsMessage<UsageError>(HasSubstr("depth is -1 mm")));
  options = sphere_on_plane(20.0, 1.25);
  options.indenter.kind = PressIndenter::Kind::kPlane;
  EXPECT_THAT([&] { press(options); }, ThrowsMessage<UsageError>(HasSubstr("without end")));
  options = sphere_on_plane(20.0, 1.25);
  options.specimen.kind = PressSpecimen::Kind::kHandRegion;
  EXPECT_THAT([&] { press(options); }, ThrowsMessage<UsageError>(HasSubstr("needs a hand")));
}

}  // namespace
}  // namespace palmar
