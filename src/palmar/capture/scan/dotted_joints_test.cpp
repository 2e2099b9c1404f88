// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/scan/dotted_joints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"

namespace palmar {
namespace {

const Vec3 kHinge = Vec3(1.0, 0.05, -0.08).normalized();
const Vec3 kPoint(10.0, 40.0, 2.0);
const std::vector<Vec3> kDotsPerBone{{6.0, 52.0, 8.0}, {10.0, 47.0, 9.0}, {14.0, 53.0, 8.0}};

std::vector<Vec3> turned(double angle, double noise = 0.0) {
  RandomStream random(7, 1);
  std::vector<Vec3> after;
  for (const Vec3& p : kDotsPerBone) {
    after.push_back(Rigid3::about_axis(kHinge, kPoint, angle) * p +
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

TEST(DottedJoints, RefusesListsThatDontMatch) {
  EXPECT_THROW(fit_dot_hinge(kDotsPerBone, std::vector<Vec3>(2, Vec3::Zero()), {}), UsageError);
  EXPECT_THROW(fit_dot_hinge({}, {}, {}), UsageError);
}

}  // namespace
}  // namespace palmar
