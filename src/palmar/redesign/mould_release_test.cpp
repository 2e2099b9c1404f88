// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/mould_release.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"

namespace palmar::redesign {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kTwoDegrees = 2.0 * std::numbers::pi / 180.0;

HandleShape bar(const HandleFeatures& features) {
  HandleShape shape{.features = features};
  shape.body.is_whole = true;
  shape.body.bottom = -60.0;
  shape.body.top = 60.0;
  shape.body.centre = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  return shape;
}

TEST(MouldRelease, OfAnOvalIsItsLandAtThePartingLineWithoutUndercut) {
  // (a cos t, b sin t) leans less than w where tan t < b / a tan w: b sin t high to both sides.
  const auto land = [](double a, double b) {
    return 2.0 * b * std::sin(std::atan(b / a * std::tan(kTwoDegrees)));
  };
  const HandleShape oval = bar({.width = 30.0, .depth = 44.0});
  const MouldRelease towards_palm = mould_release(oval, Vec3::UnitY(), kTwoDegrees);
  EXPECT_NEAR(towards_palm.undercut, 0.0, 1e-9);
  // Places are 1 degree of anomaly apart: 0.4 mm at the parting line, at both ends of the land.
  EXPECT_NEAR(towards_palm.steep_height, land(15.0, 22.0), 0.8);
  const MouldRelease sideways = mould_release(oval, Vec3(-3.0, 0.0, 0.0), kTwoDegrees);
  EXPECT_NEAR(sideways.steep_height, land(22.0, 15.0), 0.6);
  EXPECT_LT(sideways.steep_height, towards_palm.steep_height);
}

TEST(MouldRelease, FlatWallsAlongThePullDragAlongTheirHeight) {
  const HandleShape brick = bar({.width = 30.0, .depth = 40.0, .squareness = 2.0});  // p = 8
  // |x / a|^8 + |y / b|^8 = 1 leans by (x / a)^7 / a against (y / b)^7 / b: with x about a, less
  // than w up to y = b (b / a tan w)^(1 / 7).
  const double reach = 20.0 * std::pow(20.0 / 15.0 * std::tan(kTwoDegrees), 1.0 / 7.0);
  EXPECT_NEAR(mould_release(brick, Vec3::UnitY(), kTwoDegrees).steep_height, 2.0 * reach, 1.0);
  // Turned by 45 degrees it parts along its corners and nothing drags.
  HandleFeatures turned = brick.features;
  turned.turn = 0.25 * std::numbers::pi;
  EXPECT_LT(mould_release(bar(turned), Vec3::UnitY(), kTwoDegrees).steep_height, 2.0);
}

TEST(MouldRelease, AHollowInTheSideIsAnUndercutOnlyAcrossThePull) {
  HandleShape shape = bar({.width = 30.0, .depth = 30.0, .thumb_rest = 4.0});
  shape.body.hands.thumb_phi = 0.0;  // at +x
  // In the section under the thumb x = (15 - 4 ((1 + cos phi) / 2)^12) cos phi, 11 in its middle;
  // the sections that are looked at are up to a millimetre beside that.
  double widest = 0.0;
  for (double phi = 0.0; phi < 1.5; phi += 1e-3) {
    widest =
        std::max(widest, (15.0 - 4.0 * std::pow(0.5 * (1.0 + std::cos(phi)), 12)) * std::cos(phi));
  }
  const double undercut = mould_release(shape, Vec3::UnitY(), kTwoDegrees).undercut;
  EXPECT_LE(undercut, widest - 11.0 + 1e-6);
  EXPECT_GT(undercut, 0.9 * (widest - 11.0));
  EXPECT_NEAR(mould_release(shape, Vec3::UnitX(), kTwoDegrees).undercut, 0.0, 1e-9);
}

TEST(MouldRelease, APullAlongTheHandleIsRefused) {
  EXPECT_THAT([] { mould_release(bar({}), Vec3(0.0, 1.0, 1.0), kTwoDegrees); },
              ThrowsMessage<UsageError>(HasSubstr("\"pull\" is 45 degrees off the sections")));
}

}  // namespace
}  // namespace palmar::redesign
