// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/dotted_joints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"

namespace palmar::capture {
namespace {

const Vec3 kHinge = Vec3(1.0, 0.05, -0.08).normalized();
const Vec3 kPoint(10.0, 40.0, 2.0);
const std::vector<Vec3> kDotsPerBone{{6.0, 52.0, 8.0}, {10.0, 47.0, 9.0}, {14.0, 53.0, 8.0}};

std::vector<Vec3> turned(double angle, double noise = 0.0) {
  RandomStream random(7, 1);
  std::vector<Vec3> after;
  for (const Vec3& p : kDotsPerBone) {
    after.push_back(geometry::Rigid3::about_axis(kHinge, kPoint, angle) * p +
                    noise * Vec3(random.normal(), random.normal(), random.normal()));
  }
  return after;
}

double degrees_off(const DotHinge& h) {
  return std::acos(std::min(1.0, std::abs(h.axis.dot(kHinge)))) * 57.29578;
}

TEST(DottedJoints, ExactDotsDetermineTheHinge) {
  HingePrior prior;  // knows nearly nothing
  prior.axis = Vec3(1.0, -0.15, 0.1).normalized();
  prior.point = kPoint + Vec3(0.0, 3.0, -2.0);
  prior.axis_sd = 10.0;
  prior.point_sd = 1000.0;
  prior.turn = 0.7;
  const DotHinge hinge = fit_dot_hinge(kDotsPerBone, turned(0.9), prior);
  EXPECT_NEAR(hinge.turn, 0.9, 1e-4);
  EXPECT_LT(degrees_off(hinge), 0.01);
  EXPECT_LT((hinge.point - kPoint).cross(kHinge).norm(), 1e-2);
  EXPECT_LT(hinge.residual, 1e-4);
}

TEST(DottedJoints, WithoutATurnWhatIsKnownStays) {
  HingePrior prior;
  prior.axis = kHinge;
  prior.point = kPoint;
  const DotHinge hinge = fit_dot_hinge(kDotsPerBone, kDotsPerBone, prior);
  EXPECT_LT(degrees_off(hinge), 1e-3);
  EXPECT_LT((hinge.point - kPoint).norm(), 1e-6);
  EXPECT_NEAR(hinge.turn, 0.0, 1e-6);
}

TEST(DottedJoints, NoisyDotsAndWhatIsKnownTogetherAreNearerThanDotsAlone) {
  HingePrior known;
  known.axis = kHinge;
  known.point = kPoint;
  known.turn = 0.8;
  HingePrior open = known;
  open.axis_sd = 10.0;
  open.point_sd = 1000.0;
  const auto after = turned(0.9, 1.0);
  EXPECT_LT(degrees_off(fit_dot_hinge(kDotsPerBone, after, known)),
            degrees_off(fit_dot_hinge(kDotsPerBone, after, open)));
}

/// Mean errors over persons whose axis is off the prior's by so much, in degrees.
struct MeanErrors {
  double both = 0.0, dots = 0.0, prior = 0.0, within = 0.0, conflicts = 0.0;
};
MeanErrors mean_errors(double off_degrees, double noise, double turn, double dot_sd = 1.0) {
  MeanErrors mean;
  constexpr int kPersons = 300;
  RandomStream random(11, 3);
  for (int k = 0; k < kPersons; ++k) {
    HingePrior prior;
    prior.point = kPoint;
    prior.turn = turn;
    prior.dot_sd = dot_sd;
    const double way = 6.283185 * k / kPersons, off = off_degrees / 57.29578;
    const Vec3 a = kHinge.unitOrthogonal();
    prior.axis = (kHinge + std::tan(off) * (std::cos(way) * a + std::sin(way) * kHinge.cross(a)))
                     .normalized();
    std::vector<Vec3> before, after;
    for (const Vec3& p : kDotsPerBone) {
      before.push_back(p);
      after.push_back(geometry::Rigid3::about_axis(kHinge, kPoint, turn) * p +
                      noise * Vec3(random.normal(), random.normal(), random.normal()));
    }
    HingePrior open = prior;
    open.axis_sd = 10.0;
    const DotHinge both = fit_dot_hinge(before, after, prior);
    mean.both += degrees_off(both) / kPersons;
    mean.dots += degrees_off(fit_dot_hinge(before, after, open)) / kPersons;
    mean.prior += off_degrees / kPersons;
    // 2.4477: radius that holds 95 % of two normal dimensions.
    mean.within += degrees_off(both) / 57.29578 < 2.4477 * both.axis_error ? 1.0 / kPersons : 0.0;
    mean.conflicts += both.is_conflict ? 1.0 / kPersons : 0.0;
  }
  return mean;
}

// A little finger whose axis is 15 degrees off the model's while its own dots know it to 3.8: three
// dots about 6 mm apart that err by half a millimetre, as those of the whole hand show.
TEST(DottedJoints, DotsThatKnowBetterOutweighWhatIsTakenToBeKnown) {
  const MeanErrors mean = mean_errors(15.0, 0.5, 1.1, 0.5);
  EXPECT_LT(mean.dots, 4.2);
  EXPECT_LT(mean.both, 1.4 * mean.dots);
  EXPECT_GT(mean.conflicts, 0.2);
}

// Dots that slide by 1.5 mm after a turn of 20 degrees know next to nothing.
TEST(DottedJoints, DotsThatKnowLittleLeaveWhatIsKnown) {
  const MeanErrors mean = mean_errors(4.0, 1.5, 0.35);
  EXPECT_GT(mean.dots, 12.0);
  EXPECT_LT(mean.both, 6.0);
  EXPECT_LT(mean.conflicts, 0.05);
}

TEST(DottedJoints, TheStandardErrorIsHonestAndConflictsAreRare) {
  // Persons as far off as the prior says: 6 degrees in either direction are 8 in the mean.
  for (const double turn : {0.5, 1.1}) {
    const MeanErrors mean = mean_errors(7.5, 1.0, turn);
    EXPECT_LT(mean.both, std::min(mean.dots, mean.prior)) << turn;
    EXPECT_GT(mean.within, 0.9) << turn;
    EXPECT_LT(mean.conflicts, 0.1) << turn;
  }
}

TEST(DottedJoints, TheDotsNoiseIsThatOfAllPartsTogether) {
  for (const double noise : {0.7, 1.0, 1.3}) {
    RandomStream random(5, 2);
    std::vector<DotGroup> groups(14);
    for (DotGroup& group : groups) {
      const geometry::Rigid3 motion =
          geometry::Rigid3::about_axis(kHinge, kPoint, 0.3 + 0.1 * random.normal());
      for (const Vec3& p : kDotsPerBone) {
        group.before.push_back(p);
        group.after.push_back(motion * p +
                              noise * Vec3(random.normal(), random.normal(), random.normal()));
      }
    }
    // 42 degrees of freedom: within 11 % (standard deviation), drawn a little to 1 mm.
    EXPECT_NEAR(noise_of_dots(groups), noise, 0.25 * noise) << noise;
  }
  EXPECT_EQ(noise_of_dots({}), 1.0);
  const std::vector<DotGroup> exact(30, {kDotsPerBone, kDotsPerBone});
  EXPECT_EQ(noise_of_dots(exact), 0.5);
}

TEST(DottedJoints, RefusesListsThatDontMatch) {
  EXPECT_THROW(fit_dot_hinge(kDotsPerBone, std::vector<Vec3>(2, Vec3::Zero()), {}), UsageError);
  EXPECT_THROW(fit_dot_hinge({}, {}, {}), UsageError);
}

}  // namespace
}  // namespace palmar::capture
