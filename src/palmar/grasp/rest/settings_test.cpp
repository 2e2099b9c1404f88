// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "palmar/core/error.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/product/primitives.h"

namespace palmar::grasp {
namespace {

using testing::HasSubstr;

template <typename Settings>
std::string refusal(const Settings& settings) {
  try {
    settings.check();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FrictionSettings, KilogramWeighsWhatStandardGravitySays) {
  FrictionSettings settings;
  settings.mass = 2.0;
  EXPECT_DOUBLE_EQ(settings.options().load.weight, 19.6133);  // N; CGPM 1901
}

TEST(FrictionSettings, DensityTimesVolumeIsTheWeight) {
  FrictionSettings settings;
  settings.density = 1.0;  // g/cm^3: water
  product::CylinderProductOptions cylinder;
  cylinder.diameter = 100.0;
  cylinder.length = 100.0;
  cylinder.fineness.chordal_error = 0.01;
  const double litres = std::numbers::pi / 4.0;
  EXPECT_NEAR(settings.options_for(product::make_cylinder_product(cylinder)).load.weight,
              litres * 9.80665,
              0.005);  // N; the mesh lies inside the cylinder
}

TEST(FrictionSettings, AccelerationUpwardsAddsToTheWeight) {
  FrictionSettings settings;
  settings.weight = 10.0;
  settings.acceleration = 0.5;
  EXPECT_DOUBLE_EQ(settings.options().load.weight, 15.0);  // N; m (g + a)
  settings.weight = std::nullopt;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"acceleration\" needs what is accelerated"));
  settings.mass = 1.0;
  settings.acceleration = -0.1;
  EXPECT_EQ(refusal(settings),
            "setting \"acceleration\" is -0.1; 0 to 100 standard gravities are allowed");
}

TEST(FrictionSettings, LoadWithoutACoefficientGetsTheUsualOne) {
  FrictionSettings settings;
  EXPECT_EQ(settings.options().coefficient, 0.0);
  settings.force = Vec3(1.0, 0.0, 0.0);
  EXPECT_EQ(settings.options().coefficient, kUsualFriction);
  settings.friction = 0.0;
  EXPECT_EQ(settings.options().coefficient, 0.0);
}

TEST(FrictionSettings, CheckNamesFieldValueAndWhatIsAllowed) {
  EXPECT_EQ(refusal(FrictionSettings{}), "accepted");
  FrictionSettings settings;
  settings.mass = -1.0;
  EXPECT_EQ(refusal(settings),
            "setting \"mass\" is -1; more than 0 and at most 10000 kg is required");
  settings.mass = 1.0;
  settings.weight = 10.0;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"weight\" and setting \"density\""));
  settings = {};
  settings.gravity = Vec3::Zero();
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"gravity\" is 0,0,0"));
}

TEST(RestSettings, ShareOfAStrengthIsTheGripForce) {
  RestSettings settings;
  settings.strength = 400.0;
  settings.strength_share = 0.25;
  const BalanceOptions options = settings.options(std::nullopt);
  EXPECT_DOUBLE_EQ(options.asked_grip_force(Grip::kMediumWrap).value_or(0.0), 100.0);  // N
  // Mathiowetz 1985: a key pinch reaches 117.4 of 541.8 N.
  EXPECT_NEAR(options.asked_grip_force(Grip::kLateral).value_or(0.0), 100.0 * 117.4 / 541.8, 0.05);
}

TEST(RestSettings, CheckNamesFieldValueAndWhatIsAllowed) {
  EXPECT_EQ(refusal(RestSettings{}), "accepted");
  RestSettings settings;
  settings.strength_share = 0.3;
  EXPECT_THAT(
      refusal(settings),
      HasSubstr(R"(setting "strength share" needs setting "person" or setting "strength")"));
  settings.strength = 300.0;
  EXPECT_EQ(refusal(settings), "accepted");
  settings.strength_share = 1.5;
  EXPECT_THAT(refusal(settings),
              HasSubstr("setting \"strength share\" is 1.5; more than 0 and at most 1"));
  settings = {};
  settings.strength_share = 0.3;
  settings.person = PersonOfAge{Sex::kFemale, 12.0};
  EXPECT_THAT(refusal(settings), HasSubstr("12 years; 17 to 90 is allowed"));
  settings = {};
  settings.is_balanced = false;
  settings.grip_force = 20.0;
  EXPECT_THAT(refusal(settings),
              HasSubstr("setting \"no balance\" keeps the hand at its limit depths"));
}

TEST(RestSettings, LimitDepthsExcludeWhatElseSaysHowFirmly) {
  RestSettings settings;
  settings.limit_depths = true;
  EXPECT_EQ(refusal(settings), "accepted");
  settings.grip_force = 20.0;
  EXPECT_EQ(refusal(settings),
            "setting \"limit depths\" and setting \"grip force\" both say how firmly to grip; one "
            "is allowed");
  settings.grip_force = std::nullopt;
  settings.strength_share = 0.3;
  settings.strength = 300.0;
  EXPECT_THAT(refusal(settings),
              HasSubstr("setting \"limit depths\" and setting \"strength share\""));
  settings = {};
  settings.limit_depths = true;
  settings.is_balanced = false;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"no balance\" leaves it as it was closed"));
}

TEST(RestSettings, AHeldLoadAsksForWhatFrictionNeedsAndTheMarginOfPeople) {
  RestSettings settings;
  settings.task = HandTask::kHold;
  EXPECT_FALSE(settings.is_usual());
  BalanceOptions options = settings.options(0.4);
  EXPECT_FALSE(options.asked_grip_force(Grip::kMediumWrap));  // nothing is to be held
  options.load.weight = 6.0;
  options.load.force = Vec3(0.0, 8.0, 0.0);   // across the weight: 10 N in all
  const double opposed = 10.0 / (2.0 * 0.4);  // N, of two contacts that just hold them
  EXPECT_NEAR(*options.asked_grip_force(Grip::kMediumWrap), 1.4 * opposed, 1e-9);
  EXPECT_NEAR(*options.asked_grip_force(Grip::kTripod), 1.4 * opposed, 1e-9);
  EXPECT_FALSE(options.asked_grip_force(Grip::kFixedHook));
  EXPECT_THAT(options.asked_words(Grip::kMediumWrap), HasSubstr("1.4 times what friction needs"));
  options.friction = 0.0;
  EXPECT_FALSE(options.asked_grip_force(Grip::kMediumWrap));
}

TEST(RestSettings, AHeldLoadWithoutAMassIsThatOfASolidAsDenseAsWater) {
  RestSettings settings;
  EXPECT_FALSE(settings.load({}).has_load());
  settings.task = HandTask::kHold;
  EXPECT_EQ(settings.load({}).density, 1.0);
  EXPECT_EQ(settings.load({.mass = 2.0}).mass, 2.0);
  EXPECT_FALSE(settings.load({.mass = 2.0}).density);
  EXPECT_FALSE(settings.load({.mass = 2.0}).acceleration);
}

TEST(RestSettings, WhatIsCarriedIsHeavierByTheAccelerationOfWalking) {
  const RestSettings settings{.task = HandTask::kCarry};
  EXPECT_EQ(settings.load({.mass = 2.0}).acceleration, 0.2);
  EXPECT_EQ(settings.load({}).acceleration, 0.2);
  EXPECT_EQ(settings.load({.mass = 2.0, .acceleration = 0.5}).acceleration, 0.5);
  // A force that pulls at it is none of its mass.
  EXPECT_FALSE(settings.load({.force = Vec3(0.0, 8.0, 0.0)}).acceleration);
  EXPECT_TRUE(settings.options({}).holds_load);
}

TEST(HandTask, NamesAreReadAsTheyAreWritten) {
  for (const HandTask task : kHandTasks) EXPECT_EQ(hand_task_named(name_of(task)), task);
  try {
    hand_task_named("strike");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "setting \"task\" is \"strike\"; usual, squeeze, hold, carry or turn is required");
  }
}

TEST(RestSettings, AHeldLoadExcludesWhatElseSaysHowFirmly) {
  EXPECT_THAT(refusal(RestSettings{.task = HandTask::kHold, .limit_depths = true}),
              HasSubstr("\"limit depths\" says how firmly to grip"));
  EXPECT_THAT(refusal(RestSettings{.task = HandTask::kCarry, .grip_force = 40.0}),
              HasSubstr("\"grip force\" says how firmly to grip"));
  EXPECT_THAT(refusal(RestSettings{.task = HandTask::kHold, .turn = 2.0}),
              HasSubstr("setting \"task\" is required with it, as turn"));
  EXPECT_THAT(refusal(RestSettings{.task = HandTask::kTurn}),
              HasSubstr("setting \"turn n m\", a torque, is required with it"));
  EXPECT_THAT(refusal(RestSettings{.task = HandTask::kTurn, .turn = 2.0, .grip_force = 40.0}),
              HasSubstr("setting \"grip force\" says how firmly to grip"));
  EXPECT_THAT(refusal(RestSettings{.task = HandTask::kTurn, .turn = 60.0}),
              HasSubstr("setting \"turn\" is 60 N m; not 0, and at most 50 N m either way"));
  const RestSettings turn{.task = HandTask::kTurn, .turn = -2.0};
  EXPECT_NEAR(*turn.options({}).turn, -2000.0, 1e-9);
  EXPECT_THAT(refusal(RestSettings{.is_balanced = false, .task = HandTask::kHold}),
              HasSubstr("\"no balance\""));
}

TEST(GraspSettings, RegionsGoWithPowerGripsOnly) {
  GraspSettings settings;
  settings.placement.region = Box3(Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1.0));
  EXPECT_EQ(refusal(settings), "accepted");
  settings.grip = Grip::kTripod;
  EXPECT_THAT(refusal(settings),
              HasSubstr("setting \"region\": grip tripod takes fingertips to points"));
}

TEST(GraspSettings, AHoldIsSaidInOneWay) {
  GraspSettings settings;
  Hold hook;
  hook.grip = Grip::kFixedHook;
  settings.holding.hold = hook;
  EXPECT_EQ(refusal(settings), "accepted");
  settings.grip = Grip::kFixedHook;
  EXPECT_EQ(refusal(settings), "accepted");
  settings.grip = Grip::kMediumWrap;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"grip\" is medium_wrap, but the hold is a "
                                           "fixed_hook"));
  settings.grip.reset();
  settings.holding.number = 3;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"hold\" is given as a hold and as a number"));
  settings.holding.number.reset();
  settings.holding.part_name = "handle";
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"hold\" and setting \"part\" are both given"));
  settings.holding.part_name = "";
  settings.placement.at = Vec3(1.0, 2.0, 3.0);
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"hold\" and setting \"at\" are both given"));
  settings.holding.hold.reset();
  EXPECT_EQ(refusal(settings), "accepted");
  settings.holding.number = 3;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"hold\" and setting \"at\" are both given"));
  settings.holding.number.reset();
  settings.holding.toward = Vec3::UnitZ();
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"toward\" and setting \"at\" are both given"));
  settings.placement.at.reset();
  settings.holding.part_name = "handle";
  settings.holding.number = 3;
  settings.holding.along = 0.4;
  EXPECT_EQ(refusal(settings), "accepted");
  settings.is_place_per_hand = true;
  EXPECT_THAT(refusal(settings), HasSubstr("a hold is the same for every hand"));
}

TEST(GraspSettings, PartsAndDirectionsHaveTheirRanges) {
  GraspSettings settings;
  settings.holding.along = 1.2;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"along\" is 1.2; a fraction of the part's "
                                           "length, 0 to 1, is required"));
  settings.holding.along.reset();
  settings.holding.part = 0;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"part\" is 0; a number from 1 or a name"));
  settings.holding.part.reset();
  settings.holding.number = 0;
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"hold\" is 0; 1 (the best) or more"));
  settings.holding.number.reset();
  settings.holding.toward = Vec3::Zero();
  EXPECT_THAT(refusal(settings), HasSubstr("setting \"toward\" has no direction"));
}

TEST(GraspSettings, WhatIsSaidOfTheHoldReachesTheSearch) {
  GraspSettings settings;
  settings.grip = Grip::kLateral;
  settings.holding.part = 2;
  settings.holding.along = 0.25;
  settings.holding.toward = -Vec3::UnitX();
  settings.holding.up = Vec3::UnitY();
  settings.holding.purpose = HoldPurpose::kHandOver;
  settings.holding.number = 4;
  const GraspOptions options = settings.options();
  EXPECT_EQ(options.holds.grip, Grip::kLateral);
  EXPECT_EQ(options.holds.part, 2);
  EXPECT_EQ(options.holds.along, 0.25);
  EXPECT_EQ(options.holds.toward, -Vec3::UnitX());
  EXPECT_EQ(options.holds.up, Vec3::UnitY());
  EXPECT_EQ(options.holds.purpose, HoldPurpose::kHandOver);
  EXPECT_EQ(options.hold_rank, 4);
}

}  // namespace
}  // namespace palmar::grasp
