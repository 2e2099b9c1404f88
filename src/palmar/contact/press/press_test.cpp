// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press/press.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::contact {
namespace {

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
      const double area = std::numbers::pi * 20.0 * options.depths[i];
      EXPECT_NEAR(steps[i].area, area, 0.10 * area) << spacing << " mm";
      EXPECT_LT(steps[i].relative_residual, 1e-9);
    }
    EXPECT_NEAR(steps[2].peak_pressure, 0.04026, 0.05 * 0.04026);  // MPa
    EXPECT_NEAR(steps[2].peak_pressure / steps[2].mean_pressure, 1.5, 0.1);
    EXPECT_LT(steps[2].peak_pressure_cells, steps[2].peak_pressure);
  }
}

TEST(Press, HertzHoldsAtAnySpacing) {
  for (const double spacing : {0.4, 0.5, 1.7, 5.0}) {
    for (const double depth : {0.1, 2.0, 8.0}) {
      PressOptions options = sphere_on_plane(20.0, spacing);
      options.depths = {depth};
      const PressStep step = press(options).front();
      const double force = 16.0 / 3.0 * 0.05 * std::sqrt(20.0) * std::pow(depth, 1.5);
      const double area = std::numbers::pi * 20.0 * depth;
      EXPECT_NEAR(step.force, force, 0.005 * force) << spacing << " mm, depth " << depth;
      EXPECT_NEAR(step.area, area, 0.01 * area) << spacing << " mm, depth " << depth;
      EXPECT_NEAR(step.peak_pressure, 1.5 * force / area, 0.03 * 1.5 * force / area);
      EXPECT_LT(step.relative_residual, 1e-9);
    }
  }
}

TEST(Press, PoissonsRatioEntersAsInHertz) {
  // E* = 2 G / (1 - nu); p0 changes with it, the contact radius stays.
  PressOptions options = sphere_on_plane(20.0, 1.0);
  const PressStep incompressible = press(options).front();
  options.poisson = 0.3;
  const PressStep step = press(options).front();
  EXPECT_NEAR(step.force, 0.5 / 0.7 * incompressible.force, 1e-9);
  EXPECT_NEAR(step.area, incompressible.area, 1e-6);
}

TEST(Press, FineLatticeMeetsHertzToHalfAPercent) {
  const PressStep step = press(sphere_on_plane(20.0, std::sqrt(40.0) / 10.0)).front();
  EXPECT_NEAR(step.force, 3.3731, 0.005 * 3.3731);
}

TEST(Press, FlatPunchHasTheStiffnessOfTheClosedForm) {
  // F = 8 G a depth = 2 N per mm for a = 5 mm, G = 50 kPa.
  for (const double spacing : {5.0, 2.5, 0.5}) {
    PressOptions options = sphere_on_plane(5.0, spacing);
    options.indenter.kind = PressIndenter::Kind::kPunch;
    options.depths = {1.0};
    const PressStep step = press(options).front();
    EXPECT_NEAR(step.force, 2.0, 0.002 * 2.0) << spacing << " mm";
    EXPECT_NEAR(step.area, 25.0 * std::numbers::pi, 0.01 * 25.0 * std::numbers::pi);
  }
}

TEST(Press, TiltedPunchTouchesWithItsEdgeFirst) {
  // Once all of it touches, the force is that of its centre's depth: 8 G a (depth - a tan(tilt)).
  PressOptions options = sphere_on_plane(5.0, 1.0);
  options.indenter.kind = PressIndenter::Kind::kPunch;
  options.tilt = 2.0 * geometry::kDegree;
  options.depths = {0.05, 1.0};
  const std::vector<PressStep> steps = press(options);
  EXPECT_LT(steps[0].area, 10.0);  // a sliver
  const double force = 2.0 * (1.0 - 5.0 * std::tan(options.tilt));
  EXPECT_NEAR(steps[1].force, force, 0.005 * force);
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
  const double force = 2.0 / 3.0 * std::numbers::pi * a * b * p0;
  EXPECT_NEAR(step.force, force, 0.01 * force);
  EXPECT_NEAR(step.area, std::numbers::pi * a * b, 0.05 * std::numbers::pi * a * b);
  EXPECT_NEAR(step.peak_pressure, p0, 0.02 * p0);
}

TEST(Press, SphereOnABondedLayerMeetsTheTable) {
  // Incompressible layer of thickness h on a rigid base: F / F_Hertz, a / sqrt(R depth), p0 / mean
  // against sqrt(R depth) / h. Own quadrature of the Hankel-space problem (closed form 5 of the
  // validation cases). From 1 on the contact is wider than the skin that penetrates (sqrt 2).
  struct Row {
    double chi, force, radius, peak;
  };
  constexpr Row kTable[] = {{0.1, 1.1291, 1.041, 1.499},  {0.3, 1.5182, 1.138, 1.5},
                            {0.5, 2.1562, 1.239, 1.521},  {1.0, 5.1154, 1.411, 1.7},
                            {2.0, 18.3687, 1.577, 1.995}, {3.0, 46.3531, 1.671, 2.167}};
  const double depth = 2.0;
  const double length = std::sqrt(20.0 * depth);
  const double hertz = 16.0 / 3.0 * 0.05 * std::sqrt(20.0) * std::pow(depth, 1.5);
  for (const double spacing : {4.0, 1.0}) {
    for (const Row& row : kTable) {
      PressOptions options = sphere_on_plane(20.0, spacing);
      options.layer_thickness = length / row.chi;
      const PressStep step = press(options).front();
      EXPECT_NEAR(step.force, row.force * hertz, 0.01 * row.force * hertz) << row.chi;
      EXPECT_NEAR(std::sqrt(step.area / std::numbers::pi), row.radius * length,
                  0.01 * row.radius * length);
      EXPECT_NEAR(step.peak_pressure / step.mean_pressure, row.peak, 0.02 * row.peak) << row.chi;
      EXPECT_LT(step.relative_residual, 1e-9);
    }
  }
}

TEST(Press, PunchOnABondedLayerMeetsTheTable) {
  // F / (2 a E* depth) against a / h; source as above.
  constexpr double kTable[][2] = {{0.2, 1.2806}, {1.0, 3.6187}, {3.0, 18.1573}};
  for (const auto& [ratio, force] : kTable) {
    PressOptions options = sphere_on_plane(5.0, 1.0);
    options.indenter.kind = PressIndenter::Kind::kPunch;
    options.depths = {1.0};
    options.layer_thickness = 5.0 / ratio;
    EXPECT_NEAR(press(options).front().force, 2.0 * force, 0.005 * 2.0 * force) << ratio;
  }
}

TEST(Press, ThickLayerIsAHalfSpace) {
  PressOptions options = sphere_on_plane(20.0, 1.25);
  const PressStep half_space = press(options).front();
  options.layer_thickness = 1000.0;
  // Closed form 5 at sqrt(R depth) / h = 0.0063: 0.8 % stiffer.
  EXPECT_NEAR(press(options).front().force, 1.008 * half_space.force, 0.002 * half_space.force);
}

TEST(Press, ThinCompressibleLayerIsABedOfSprings) {
  // Where the contact is wide against the layer each point carries p = E_oed d / h alone, so that
  // F = pi R depth^2 E_oed / h with E_oed = 2 G (1 - nu) / (1 - 2 nu), and a^2 = 2 R depth.
  PressOptions options = sphere_on_plane(50.0, 1.0);
  options.depths = {0.5};
  options.layer_thickness = 0.5;
  options.poisson = 0.2;
  const double modulus = 2.0 * 0.05 * 0.8 / 0.6;
  const double force = std::numbers::pi * 50.0 * 0.25 * modulus / 0.5;
  const PressStep step = press(options).front();
  EXPECT_NEAR(step.force, force, 0.06 * force);  // the edge, h / a = 0.07 wide, adds
  EXPECT_NEAR(step.area, std::numbers::pi * 50.0, 0.06 * std::numbers::pi * 50.0);
}

/// Two flat punches of radius 1 in one holder, their axes d apart: force of each over that of a
/// punch alone. Galerkin with the pressures of an upright and of a tilted punch, which are exact
/// for a punch alone (Johnson 1985, sections 3.8, 5.3):
///
///     p0 = 1 / (pi sqrt(1 - r^2)),    u0 = 2/pi asin(1/rho) outside, 1 inside
///     p1 = 2 x / (pi sqrt(1 - r^2)),  u1 = 2/pi x (asin(1/rho) - sqrt(rho^2 - 1) / rho^2), x
///     inside
///
/// (E* = 1). As the pressures are trials, the force is a lower bound.
double two_punches(double d) {
  constexpr int kSteps = 200;
  double A[2][2] = {};
  for (int i = 0; i < kSteps; ++i) {
    // r = sin t takes the root out of the integral.
    const double t = (i + 0.5) * std::numbers::pi / 2.0 / kSteps;
    for (int j = 0; j < kSteps; ++j) {
      const double phi = (j + 0.5) * 2.0 * std::numbers::pi / kSteps;
      const double x = std::sin(t) * std::cos(phi);
      const double y = std::sin(t) * std::sin(phi);
      const double from_other = d - x;  // mirrored, so that both lean the same way
      const double rho = std::hypot(from_other, y);
      const double u[] = {2.0 / std::numbers::pi * std::asin(1.0 / rho),
                          2.0 / std::numbers::pi * from_other *
                              (std::asin(1.0 / rho) - std::sqrt(rho * rho - 1.0) / (rho * rho))};
      const double p[] = {1.0 / std::numbers::pi, 2.0 * x / std::numbers::pi};
      const double weight =
          std::sin(t) * std::numbers::pi / 2.0 / kSteps * 2.0 * std::numbers::pi / kSteps;
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) A[a][b] += weight * p[a] * u[b];
      }
    }
  }
  A[0][0] += 2.0;
  A[1][1] += 4.0 / 3.0;
  return 2.0 * A[1][1] / (A[0][0] * A[1][1] - A[0][1] * A[1][0]);
}

TEST(Press, TwoPunchesTakeForceFromEachOther) {
  for (const double ratio : {2.5, 3.0, 10.0}) {
    PressOptions options = sphere_on_plane(5.0, 1.0);
    options.indenter = {PressIndenter::Kind::kTwoPunches, 5.0, 5.0 * ratio};
    options.depths = {1.0};
    const PressStep step = press(options).front();
    const double expected = two_punches(ratio);
    EXPECT_NEAR(step.force / 4.0, expected, 0.003 * expected) << ratio;
    EXPECT_NEAR(step.area, 50.0 * std::numbers::pi, 0.01 * 50.0 * std::numbers::pi);
    // Far away each acts on the other like a point force: 1 / (1 + 2 a / (pi d)).
    if (ratio < 4.0) continue;
    EXPECT_NEAR(step.force / 4.0, 1.0 / (1.0 + 2.0 / (std::numbers::pi * ratio)), 0.003);
  }
  // Three radii apart: 18 % of the force is lost.
  EXPECT_NEAR(two_punches(3.0), 0.82, 0.005);
}

TEST(Press, ThickCoverGivesWayInSeries) {
  // Two half-spaces: 1 / E* = 1 / E1* + 1 / E2*, E* = 2 G / (1 - nu).
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.coating = Coating{1000.0, 0.1, 0.3, {}};
  const double modulus = 1.0 / (1.0 / 0.2 + 0.7 / 0.2);
  const double force = 4.0 / 3.0 * modulus * std::sqrt(20.0) * std::pow(2.0, 1.5);
  const PressStep step = press(options).front();
  EXPECT_NEAR(step.force, force, 0.006 * force);
  EXPECT_NEAR(step.area, std::numbers::pi * 40.0, 0.02 * std::numbers::pi * 40.0);
}

TEST(Press, CoverOnRigidSkinIsALayer) {
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.shear_modulus = 1e4;
  options.coating = Coating{std::sqrt(40.0), 0.05, 0.5, {}};
  EXPECT_NEAR(press(options).front().force, 5.1154 * 3.3731, 0.01 * 5.1154 * 3.3731);
}

TEST(Press, StiffCoverChangesNothing) {
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.layer_thickness = 6.0;
  const PressStep rigid = press(options).front();
  options.coating = Coating{4.0, 1e4, 0.5, {}};
  EXPECT_NEAR(press(options).front().force, rigid.force, 1e-4 * rigid.force);
}

TEST(Press, ForceGrowsEvenlyWithDepth) {
  for (const bool is_layered : {false, true}) {
    PressOptions options = sphere_on_plane(20.0, 1.7);
    if (is_layered) options.layer_thickness = 5.0;
    options.depths.clear();
    for (int i = 30; i <= 40; ++i) options.depths.push_back(0.05 * i);
    const std::vector<PressStep> steps = press(options);
    for (std::size_t i = 2; i < steps.size(); ++i) {
      const double before = std::log(steps[i - 1].force / steps[i - 2].force) /
                            std::log(steps[i - 1].depth / steps[i - 2].depth);
      const double exponent = std::log(steps[i].force / steps[i - 1].force) /
                              std::log(steps[i].depth / steps[i - 1].depth);
      EXPECT_GT(exponent, 1.4);
      EXPECT_NEAR(exponent, before, 0.1) << steps[i].depth << " mm";
    }
  }
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

TEST(Press, ForceControlWorksOnALayerToo) {
  PressOptions options = sphere_on_plane(20.0, 2.0);
  options.layer_thickness = 4.0;
  options.depths.clear();
  options.forces = {0.05, 2.0, 40.0};
  const std::vector<PressStep> steps = press(options);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(steps[i].force, options.forces[i], 1e-3 * options.forces[i]);
    PressOptions again = options;
    again.forces.clear();
    again.depths = {steps[i].depth};
    EXPECT_EQ(press(again).front().force, steps[i].force);
  }
}

TEST(Press, TissueLevelChoosesTheLaw) {
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.shear_modulus.reset();
  options.depths = {1.0};
  for (const hand::TissueLevel level :
       {hand::TissueLevel::kLow, hand::TissueLevel::kNominal, hand::TissueLevel::kHigh}) {
    options.tissue_level = level;
    const PressStep step = press(options).front();
    const hand::StiffeningLaw& law = hand::law_at(options.tissue.half_space, level);
    EXPECT_NEAR(step.shear_modulus, law.g0 + (law.g_limit - law.g0) / law.limit_depth, 1e-12);
  }
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
  EXPECT_NEAR(step.area, std::numbers::pi * 40.0, 0.10 * std::numbers::pi * 40.0);
}

TEST(Press, HandRegionPressedByABallMeetsHertz) {
  // 1 / R = 1 / 20 + 1 / 40; F = (16/3) G sqrt(R) depth^1.5.
  const PreparedHand hand(contact_test::ball_hand(20.0, 4));
  PressOptions options = sphere_on_plane(40.0, 1.0);
  options.specimen.kind = PressSpecimen::Kind::kHandRegion;
  const double force = 16.0 / 3.0 * 0.05 * std::sqrt(40.0 / 3.0) * std::pow(2.0, 1.5);
  EXPECT_NEAR(press(options, &hand).front().force, force, 0.04 * force);

  // A small ball up to its own radius: force grows all the way.
  options.indenter.radius = 5.0;
  options.depths = {1.0, 2.0, 3.0, 4.0, 4.5, 5.0};
  double before = 0.0;
  for (const PressStep& step : press(options, &hand)) {
    EXPECT_GT(step.force, before) << step.depth << " mm";
    EXPECT_LT(step.relative_residual, 1e-6);
    before = step.force;
  }
  options.depths.clear();
  options.forces = {0.5};
  EXPECT_NEAR(press(options, &hand).front().force, 0.5, 5e-4);
}

TEST(Press, CoverOnAHandGivesWay) {
  const PreparedHand hand(contact_test::ball_hand(20.0, 4));
  PressOptions options = sphere_on_plane(1.0, 1.0);
  options.specimen.kind = PressSpecimen::Kind::kHandRegion;
  options.indenter.kind = PressIndenter::Kind::kPlane;
  options.coating = Coating{50.0, 0.05, 0.5, {}};
  // As soft as the skin and thick: half the force (Hertz with half the E*).
  const PressStep step = press(options, &hand).front();
  EXPECT_NEAR(step.force, 0.5 * 3.3731, 0.08 * 0.5 * 3.3731);
}

TEST(Press, HandAtATissueLevelHasItForNominal) {
  const std::shared_ptr<const hand::Hand> hand = contact_test::ball_hand(20.0, 2);
  const hand::Hand high = hand_at_tissue_level(*hand, hand::TissueLevel::kHigh);
  for (std::size_t r = 0; r < hand->tissue.region.size(); ++r) {
    EXPECT_EQ(high.tissue.region[r].half_space.nominal.g_limit,
              hand->tissue.region[r].half_space.high.g_limit);
    EXPECT_EQ(high.tissue.region[r].layered.nominal.g0, hand->tissue.region[r].layered.high.g0);
  }
}

TEST(Press, RefusesWhatItCannotDo) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  PressOptions options = sphere_on_plane(20.0, 1.25);
  options.layer_thickness = 0.0;
  EXPECT_THAT([&] { press(options); },
              ThrowsMessage<UsageError>(HasSubstr("thickness of the layer is 0 mm")));
  options.layer_thickness = 5.0;
  options.kernel = Kernel::kPoint;
  EXPECT_THAT([&] { press(options); }, ThrowsMessage<UsageError>(HasSubstr("knows neither")));
  options = sphere_on_plane(20.0, 1.25);
  options.poisson = 0.6;
  EXPECT_THAT([&] { press(options); },
              ThrowsMessage<UsageError>(HasSubstr("Poisson's ratio is 0.6; 0 to 0.5")));
  options = sphere_on_plane(20.0, 1.25);
  options.coating = Coating{0.0, 1.0, 0.5, {}};
  EXPECT_THAT([&] { press(options); },
              ThrowsMessage<UsageError>(HasSubstr("thickness of the coating is 0 mm")));
  options = sphere_on_plane(20.0, 1.25);
  options.indenter = {PressIndenter::Kind::kTwoPunches, 5.0, 9.0};
  EXPECT_THAT([&] { press(options); },
              ThrowsMessage<UsageError>(HasSubstr("distance of the punches is 9 mm")));
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
}  // namespace palmar::contact
