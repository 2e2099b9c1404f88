// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/axis_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "hands/capture/two_axis_fit.h"
#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

const Vec3 kAxis = Vec3(0.8, -0.35, 0.49).normalized();
const Vec3 kOnAxis(12.0, 40.0, -7.0);

/// Distance of a point from the true axis, mm.
double off_axis(const Vec3& point) { return (point - kOnAxis).cross(kAxis).norm(); }

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / geometry::kDegree;
}

/// Surface points of a bone of 40 mm that lies 20 mm beyond the joint.
std::vector<Vec3> bone_points() {
  geometry::TriangleMesh bone = geometry::make_box({12.0, 40.0, 9.0});
  for (Vec3& v : bone.vertices) v += kOnAxis + Vec3(0.0, 40.0, 2.0);
  const std::array<Vec3, 6> points = moment_points(bone);
  return {points.begin(), points.end()};
}

TEST(FitAxis, FindsTheAxisOfTurnsFromATenthOfADegreeToNearlyAHalfTurn) {
  const Vec3 near(10.0, 42.0, -6.0);
  for (const double degrees : {0.1, 0.5, 5.0, 30.0, 90.0, 150.0, 179.0, 179.9, 179.999}) {
    const AxisFit fit =
        fit_axis(geometry::Rigid3::about_axis(kAxis, kOnAxis, degrees * geometry::kDegree), near);
    EXPECT_NEAR(fit.angle, degrees * geometry::kDegree, 1e-12) << degrees;
    EXPECT_LT(angle_between(fit.axis, kAxis), 1e-8) << degrees;
    EXPECT_LT(off_axis(fit.point), 1e-8) << degrees;
    EXPECT_NEAR((fit.point - near).dot(kAxis), 0.0, 1e-8) << degrees;  // nearest to there
    EXPECT_NEAR(fit.slide, 0.0, 1e-10) << degrees;
    EXPECT_EQ(fit.is_observed, degrees > 3.0);
  }
}

TEST(FitAxis, TheSlideAlongTheAxisIsDroppedAndReported) {
  geometry::Rigid3 screw = geometry::Rigid3::about_axis(kAxis, kOnAxis, 0.7);
  screw.translation += 1.5 * kAxis;
  const AxisFit fit = fit_axis(screw, kOnAxis);
  EXPECT_NEAR(fit.slide, 1.5, 1e-12);
  EXPECT_LT(off_axis(fit.point), 1e-10);
  // Turned the other way, the axis is the other way round and so is the slide's sign.
  geometry::Rigid3 back = geometry::Rigid3::about_axis(kAxis, kOnAxis, -0.7);
  back.translation += 1.5 * kAxis;
  EXPECT_NEAR(fit_axis(back, kOnAxis).slide, -1.5, 1e-12);
  EXPECT_LT(angle_between(fit_axis(back, kOnAxis).axis, -kAxis), 1e-8);
}

TEST(FitAxis, AQuaternionAndItsNegativeAreTheSameMotion) {
  geometry::Rigid3 motion = geometry::Rigid3::about_axis(kAxis, kOnAxis, 1.0);
  motion.rotation.coeffs() = -motion.rotation.coeffs();
  EXPECT_NEAR(fit_axis(motion, kOnAxis).angle, 1.0, 1e-12);
  EXPECT_LT(angle_between(fit_axis(motion, kOnAxis).axis, kAxis), 1e-8);
}

TEST(FitAxis, NoTurnHasNoAxis) {
  EXPECT_FALSE(fit_axis({}, kOnAxis).is_observed);
  EXPECT_EQ(fit_axis({}, kOnAxis).point, kOnAxis);
  const AxisFit shift = fit_axis({Quat::Identity(), Vec3(0.0, 3.0, 4.0)}, kOnAxis);
  EXPECT_FALSE(shift.is_observed);
  EXPECT_DOUBLE_EQ(shift.slide, 5.0);
}

TEST(MomentPoints, HaveTheSecondMomentsOfTheSurface) {
  // Surface of a box a x b x c: x^2 integrates to a^3 (b + c) / 6 over the four sides along x and
  // to a^2 b c / 2 over the two ends; the area is 2 (a b + b c + c a).
  const double a = 12.0, b = 40.0, c = 9.0;
  geometry::TriangleMesh box = geometry::make_box({a, b, c}, 3);
  for (Vec3& v : box.vertices) v += Vec3(100.0, -50.0, 20.0);
  const std::array<Vec3, 6> points = moment_points(box);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / 6.0;
  EXPECT_LT((mean - Vec3(100.0, -50.0, 20.0)).norm(), 1e-10);
  double xx = 0.0;
  for (const Vec3& p : points) xx += std::pow(p.x() - 100.0, 2) / 6.0;
  const double expected =
      (a * a * a * (b + c) / 6.0 + a * a * b * c / 2.0) / (2.0 * (a * b + b * c + c * a));
  EXPECT_NEAR(xx, expected, 1e-9);
}

TEST(FitHinge, SeveralTurnsAboutOneAxisGiveItExactly) {
  const std::vector<Vec3> points = bone_points();
  const std::vector<double> angles = {70.0 * geometry::kDegree, -12.0 * geometry::kDegree,
                                      25.0 * geometry::kDegree};
  std::vector<geometry::Rigid3> motions;
  for (const double angle : angles)
    motions.push_back(geometry::Rigid3::about_axis(kAxis, kOnAxis, angle));
  const HingeFit fit = fit_hinge(motions, points, kOnAxis);
  EXPECT_LT(angle_between(fit.axis, kAxis), 1e-5);
  EXPECT_LT(off_axis(fit.point), 1e-5);
  for (std::size_t k = 0; k < angles.size(); ++k) EXPECT_NEAR(fit.angle[k], angles[k], 1e-6);
  EXPECT_LT(fit.rms, 1e-5);
}

TEST(FitHinge, SlidesDontTiltTheAxis) {
  const std::vector<Vec3> points = bone_points();
  std::vector<geometry::Rigid3> motions;
  for (const double angle : {0.4, -0.4}) {
    motions.push_back(geometry::Rigid3::about_axis(kAxis, kOnAxis, angle));
    motions.back().translation += 3.0 * angle * kAxis;  // a screw
  }
  const HingeFit fit = fit_hinge(motions, points, kOnAxis);
  EXPECT_LT(angle_between(fit.axis, kAxis), 0.5);
  EXPECT_NEAR(fit.slide[0], 1.2, 0.05);
  EXPECT_NEAR(fit.slide[1], -1.2, 0.05);
  EXPECT_NEAR(fit.rms, 1.2, 0.1);  // what is dropped
}

TEST(FitHinge, TwoAxesGiveTheOneBetweenThem) {
  // Two equal turns about axes 6 degrees apart, one each way: the best axis lies half way.
  const std::vector<Vec3> points = bone_points();
  const Vec3 other = (kAxis + 0.1 * kAxis.unitOrthogonal()).normalized();
  const std::vector<geometry::Rigid3> motions = {geometry::Rigid3::about_axis(kAxis, kOnAxis, 0.8),
                                                 geometry::Rigid3::about_axis(other, kOnAxis, 0.8)};
  const HingeFit fit = fit_hinge(motions, points, kOnAxis);
  EXPECT_LT(angle_between(fit.axis, (kAxis + other).normalized()), 1.0);
  EXPECT_GT(fit.rms, 0.1);
}

TEST(FitTwoAxes, FindsTwoSkewAxesFromFourLimitPostures) {
  const std::vector<Vec3> points = bone_points();
  const Vec3 second = (kAxis.unitOrthogonal() + 0.12 * kAxis).normalized();
  const Vec3 on_second = kOnAxis + 4.0 * kAxis.cross(second).normalized();
  const std::vector<std::array<double, 2>> angles = {
      {0.45, 0.06}, {-0.40, -0.05}, {0.05, 0.55}, {-0.04, -0.35}};
  std::vector<geometry::Rigid3> motions;
  for (const auto& [a, b] : angles) {
    motions.push_back(geometry::Rigid3::about_axis(kAxis, kOnAxis, a) *
                      geometry::Rigid3::about_axis(second, on_second, b));
  }
  const std::vector<MainAxis> main = {MainAxis::kFirst, MainAxis::kFirst, MainAxis::kSecond,
                                      MainAxis::kSecond};
  TwoAxisPrior prior;
  prior.near = kOnAxis + Vec3(1.0, 1.0, -1.0);
  prior.first = (kAxis + Vec3(0.1, 0.1, 0.0)).normalized();
  prior.second = (second + Vec3(0.0, -0.1, 0.1)).normalized();
  prior.point_sd = 0.01;  // exact motions
  prior.square_sd = 0.3;
  const TwoAxisFit fit = fit_two_axes(motions, main, points, prior);
  EXPECT_LT(angle_between(fit.first_axis, kAxis), 0.5);
  EXPECT_LT(angle_between(fit.second_axis, second), 0.5);
  EXPECT_LT((fit.second_point - on_second).cross(second).norm(), 0.3);
  EXPECT_LT(fit.rms, 0.02);
  EXPECT_TRUE(fit.is_first_observed && fit.is_second_observed);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    EXPECT_NEAR(fit.angle[k][0], angles[k][0], 0.01);
    EXPECT_NEAR(fit.angle[k][1], angles[k][1], 0.01);
  }
}

TEST(FitTwoAxes, AnAxisThatNothingTurnsAboutStaysAtThePrior) {
  const std::vector<Vec3> points = bone_points();
  const std::vector<geometry::Rigid3> motions = {geometry::Rigid3::about_axis(kAxis, kOnAxis, 1.2)};
  TwoAxisPrior prior;
  prior.near = kOnAxis;
  prior.first = kAxis;
  prior.second = kAxis.unitOrthogonal();
  const std::vector<MainAxis> main = {MainAxis::kFirst};
  const TwoAxisFit fit = fit_two_axes(motions, main, points, prior);
  EXPECT_TRUE(fit.is_first_observed);
  EXPECT_FALSE(fit.is_second_observed);
  EXPECT_LT(angle_between(fit.second_axis, prior.second), 0.1);
}

/// A motion as registration shows it: the bone, 40 mm from the joint, turned wrongly by `turn`
/// [rad] about each axis and shifted by `shift` [mm], standard deviations.
geometry::Rigid3 seen(const geometry::Rigid3& motion, double turn, double shift,
                      RandomStream& random) {
  const auto draw = [&](double sd) {
    return Vec3(sd * random.normal(), sd * random.normal(), sd * random.normal());
  };
  const Vec3 wrong = draw(turn), centre = motion * (kOnAxis + Vec3(0.0, 40.0, 2.0));
  geometry::Rigid3 error = geometry::Rigid3::about_axis(wrong.normalized(), centre, wrong.norm());
  error.translation += draw(shift);
  return error * motion;
}

/// Share of fits of hinges, of `count` motions each, that have the true axis within their 95 %.
double hinge_coverage(int count, double least, double most, double turn_error) {
  constexpr int kTrials = 500;
  const std::vector<Vec3> points = bone_points();
  int inside = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream random(7, static_cast<std::uint64_t>(trial));
    std::vector<geometry::Rigid3> motions;
    for (int k = 0; k < count; ++k) {
      const double angle = (least + (most - least) * random.uniform()) * geometry::kDegree;
      motions.push_back(
          seen(geometry::Rigid3::about_axis(kAxis, kOnAxis, angle), turn_error, 0.05, random));
    }
    const HingeFit fit = fit_hinge(motions, points, kOnAxis);
    const double off = std::asin(std::min(1.0, fit.axis.cross(kAxis).norm()));
    inside += off <= kWithin95 * fit.axis_error ? 1 : 0;
  }
  return static_cast<double>(inside) / kTrials;
}

TEST(FitHinge, ItsErrorIsThatOfTheTurnsOverTheTurns) {
  const std::vector<Vec3> points = bone_points();
  const auto error_of = [&](std::vector<double> degrees) {
    std::vector<geometry::Rigid3> motions;
    for (const double angle : degrees) {
      motions.push_back(geometry::Rigid3::about_axis(kAxis, kOnAxis, angle * geometry::kDegree));
    }
    return fit_hinge(motions, points, kOnAxis).axis_error / geometry::kDegree;
  };
  // 1.13 degrees over three, over sixty (its chord); four like turns show twice as much as one,
  // and a small one beside a large one hardly anything.
  EXPECT_NEAR(error_of({3.0}), 21.56, 0.1);
  EXPECT_NEAR(error_of({60.0}), 1.129, 0.01);
  EXPECT_NEAR(error_of({60.0, 60.0, 60.0, 60.0}), 0.564, 0.005);
  EXPECT_NEAR(error_of({60.0, 3.0}), 1.127, 0.01);
}

TEST(FitHinge, NineteenOfTwentyAxesLieWithinTheirErrors) {
  for (const int count : {1, 2, 4}) {
    for (const auto& [least, most] : {std::pair{4.0, 12.0}, std::pair{20.0, 90.0}}) {
      const double share = hinge_coverage(count, least, most, kTurnError);
      EXPECT_GE(share, 0.90) << count << " turns of " << least << " to " << most;
      EXPECT_LE(share, 0.98) << count << " turns of " << least << " to " << most;
    }
  }
  // Motions three times worse than is taken for granted show it by their spread, if not all of it:
  // without that 1 - exp(-(2.45 / 3)^2 / 2) = 28 % would lie inside.
  EXPECT_GE(hinge_coverage(4, 20.0, 90.0, 3.0 * kTurnError), 0.75);
}

TEST(FitTwoAxes, NineteenOfTwentyAxesLieWithinTheirErrors) {
  constexpr int kTrials = 300;
  const std::vector<Vec3> points = bone_points();
  TwoAxisPrior prior;
  prior.near = kOnAxis;
  prior.first = kAxis;
  prior.second = kAxis.unitOrthogonal();
  prior.first_sd = prior.second_sd = 0.12;
  prior.slide_sd = 0.4;
  const auto tilted = [](const Vec3& axis, double sd, RandomStream& random) {
    const Vec3 e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
    const double a = sd * random.normal(), b = sd * random.normal();
    return (axis + a * e1 + b * e2).normalized();
  };
  int first = 0, second = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream random(11, static_cast<std::uint64_t>(trial));
    Vec3 bends, spreads;
    double square = 0.0;
    do {  // square to each other as the prior has it
      bends = tilted(prior.first, prior.first_sd, random);
      spreads = tilted(prior.second, prior.second_sd, random);
      square = bends.dot(spreads) / prior.square_sd;
    } while (random.uniform() > std::exp(-0.5 * square * square));
    // A fist that spreads or draws in by what nobody knows, and spread fingers that hardly bend.
    const auto motion = [&](double a, double b) {
      return seen(geometry::Rigid3::about_axis(bends, kOnAxis, a) *
                      geometry::Rigid3::about_axis(spreads, kOnAxis, b),
                  0.3 * geometry::kDegree, 0.05, random);
    };
    const std::vector<geometry::Rigid3> motions = {
        motion(1.1, prior.by_first_sd * random.normal()),
        motion(prior.by_second_sd * random.normal(), 0.26)};
    const std::vector<MainAxis> main = {MainAxis::kFirst, MainAxis::kSecond};
    const TwoAxisFit fit = fit_two_axes(motions, main, points, prior);
    first +=
        angle_between(fit.first_axis, bends) * geometry::kDegree <= kWithin95 * fit.first_error;
    second +=
        angle_between(fit.second_axis, spreads) * geometry::kDegree <= kWithin95 * fit.second_error;
  }
  for (const int inside : {first, second}) {
    EXPECT_GE(inside, 0.90 * kTrials);
    EXPECT_LE(inside, 0.98 * kTrials);
  }
}

TEST(FitHinge, WithoutMotionsSaysSo) {
  const std::vector<Vec3> points = bone_points();
  EXPECT_THROW(fit_hinge({}, points, kOnAxis), UsageError);
  EXPECT_THROW(fit_two_axes({}, {}, points, {}), UsageError);
}

}  // namespace
}  // namespace palmar::capture
