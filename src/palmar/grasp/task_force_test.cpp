// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/task_force.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <vector>

#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/grasp/rest/usual_task.h"
#include "palmar/product/primitives.h"

namespace palmar::grasp {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Steiber 2016, 45 to 49 years: men 53.0 kg, women 34.1 kg; standard gravity. N.
constexpr double kStrength = 0.5 * (53.0 + 34.1) * 9.80665;

product::Product cylinder(double diameter, double length) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  options.length = length;
  options.fineness.chordal_error = 0.01;
  product::Product product = product::make_cylinder_product(options);
  product.name = "kettle";
  return product;
}

TEST(UsualShare, IsAQuarterOfTheMeanStrengthOfWomenAndMen) {
  const ShareOfStrength usual = usual_share(0.5);
  EXPECT_NEAR(usual.force(Grip::kMediumWrap), 0.25 * kStrength, 1e-9);
  EXPECT_FALSE(usual.is_raised(Grip::kMediumWrap));
  EXPECT_EQ(
      usual.words(Grip::kMediumWrap),
      "25 % of what women and men of 45 years (mean; Steiber 2016) reach on a dynamometer, 427 N");
}

TEST(UsualShare, OfAPinchIsThatShareOfWhatThePinchReaches) {
  // Mathiowetz 1985: a key pinch reaches 117.4 of 541.8 N.
  const ShareOfStrength usual = usual_share(0.5);
  EXPECT_NEAR(usual.force(Grip::kLateral), 0.25 * kStrength * 117.4 / 541.8, 1e-9);
  EXPECT_THAT(usual.words(Grip::kLateral), HasSubstr("25 % of the 93 N of such a pinch"));
}

TEST(UsualShare, IsRaisedToWhatFrictionNeedsAndFourTenthsMore) {
  HeaviestLoad kettle{.force = 90.0, .product = "kettle"};
  constexpr Grip kWrap = Grip::kMediumWrap;
  // Two sides, each with mu times the grip force: 90 N / (2 x 0.5), and 1.4 times that.
  const ShareOfStrength usual = usual_share(0.5, kettle);
  EXPECT_TRUE(usual.is_raised(kWrap));
  EXPECT_NEAR(usual.force(kWrap), 126.0, 1e-9);
  EXPECT_THAT(usual.words(kWrap),
              AllOf(HasSubstr("raised from 107 N to hold the 90.0 N of kettle by"),
                    Not(HasSubstr("estimated"))));
  // A pinch can't: all of its strength is the most.
  EXPECT_NEAR(usual.force(Grip::kLateral), kStrength * 117.4 / 541.8, 1e-9);
  // Half the friction, twice the force.
  EXPECT_NEAR(usual_share(0.25, kettle).force(kWrap), 252.0, 1e-9);
  // What friction doesn't hold is no reason to grip harder.
  EXPECT_FALSE(usual_share(0.0, kettle).is_raised(kWrap));
  kettle.force = 20.0;
  EXPECT_FALSE(usual_share(0.5, kettle).is_raised(kWrap));
}

TEST(HeaviestLoad, IsTheLargestOfAllProducts) {
  HeaviestLoad heaviest;
  contact::ProductLoad load;
  load.weight = 3.0;
  heaviest.add(cylinder(30.0, 100.0), load);
  load.weight = 5.0;
  load.force = Vec3(12.0, 0.0, 0.0);  // beside a weight of 5 N downwards
  heaviest.add(cylinder(30.0, 100.0), load);
  load = {};
  load.weight = 4.0;
  heaviest.add(cylinder(30.0, 100.0), load);
  EXPECT_NEAR(heaviest.force, 13.0, 1e-12);  // N; 5, 12, 13
  EXPECT_FALSE(heaviest.is_estimated);
}

TEST(HeaviestLoad, WithoutAWeightIsThatOfAsMuchWater) {
  HeaviestLoad heaviest;
  heaviest.add(cylinder(150.0, 150.0), {});
  // pi/4 x 1.5^3 litres; the mesh lies inside the cylinder.
  const double weight = std::numbers::pi / 4.0 * 3.375 * 9.80665;
  EXPECT_NEAR(heaviest.force, weight, 0.01);
  EXPECT_TRUE(heaviest.is_estimated);
  const ShareOfStrength usual = usual_share(0.5, heaviest);
  EXPECT_NEAR(usual.force(Grip::kLateral), 1.4 * weight, 0.02);
  EXPECT_THAT(usual.words(Grip::kLateral),
              HasSubstr("of kettle (no mass is given; estimated as solid, 1 g/cm3)"));
}

TEST(HeaviestLoad, OfASurfaceThatEnclosesNothingIsNotEstimated) {
  product::Product open = cylinder(50.0, 100.0);
  geometry::TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {40, 0, 0}, {40, 140, 0}, {0, 140, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  open.mesh = sheet;
  HeaviestLoad heaviest;
  heaviest.add(open, {});
  EXPECT_EQ(heaviest.force, 0.0);
}

TEST(RestSettings, WithoutAWordTheUsualGripForceIsAskedFor) {
  const RestSettings nothing_said;
  const BalanceOptions usual = nothing_said.options(std::nullopt);
  EXPECT_NEAR(usual.asked_grip_force(Grip::kMediumWrap).value_or(0.0), 0.25 * kStrength, 1e-9);
  EXPECT_THAT(usual.asked_words(Grip::kMediumWrap), HasSubstr("Steiber 2016"));
  const HeaviestLoad kettle{.force = 90.0, .product = "kettle"};
  EXPECT_NEAR(*nothing_said.options(0.25, kettle).asked_grip_force(Grip::kMediumWrap), 252.0, 1e-9);
}

TEST(RestSettings, WhatIsSaidIsNeitherReplacedNorRaised) {
  const HeaviestLoad anvil{.force = 900.0, .product = "anvil"};
  const auto asked = [&](const RestSettings& said) {
    return said.options(std::nullopt, anvil).asked_grip_force(Grip::kMediumWrap);
  };
  RestSettings said;
  said.grip_force = 30.0;
  EXPECT_EQ(asked(said), 30.0);
  said = {};
  said.strength = 400.0;
  said.strength_share = 0.1;
  EXPECT_DOUBLE_EQ(asked(said).value_or(0.0), 40.0);
  said = {};
  said.limit_depths = true;
  EXPECT_FALSE(asked(said));
  said = {};
  said.is_balanced = false;
  EXPECT_FALSE(asked(said));
}

TEST(BalanceOptions, HookedFingersCarryAndAreNotAskedToSqueeze) {
  EXPECT_FALSE(RestSettings().options(std::nullopt).asked_grip_force(Grip::kFixedHook));
}

// A can holds 2.0 N: 1.4 x 2.0 / (2 x 0.5) = 2.8 N, whatever the hand could.
TEST(UsualShare, OfWhatIsOnlyHeldIsWhatItsWeightAsksFor) {
  ShareOfStrength held = usual_share(0.5, {.force = 2.0, .product = "can"});
  held.holds_only = true;
  EXPECT_NEAR(held.force(Grip::kLargeDiameter), 2.8, 1e-9);
  EXPECT_FALSE(held.is_raised(Grip::kLargeDiameter));
  EXPECT_THAT(held.words(Grip::kLargeDiameter), HasSubstr("what holds the 2.0 N of can"));
  ShareOfStrength card = usual_share(0.5, {.force = 0.05, .product = "card"});
  card.holds_only = true;
  EXPECT_NEAR(card.force(Grip::kTipPinch), kLightestHold, 1e-12);
  EXPECT_THAT(card.words(Grip::kTipPinch), HasSubstr("even the lightest thing"));
  // A button isn't held.
  EXPECT_NEAR(card.force(Grip::kFingerPush), 0.25 * card.reached(Grip::kFingerPush), 1e-9);
}

Grasp taken(Grip grip) {
  Grasp grasp;
  grasp.grip = grip;
  grasp.grip_axis = Vec3::UnitZ();
  return grasp;
}

TEST(UsualTask, IsToGripAHandleAndToHoldABody) {
  constexpr double kHand = 184.0;  // mm; thumb and fingers meet round 66
  const product::Product bar = cylinder(40.0, 120.0);
  EXPECT_EQ(usual_task(bar, taken(Grip::kMediumWrap), kHand), UsualTask::kGrip);
  EXPECT_EQ(usual_task(bar, taken(Grip::kPalmarPinch), kHand), UsualTask::kHold);
  EXPECT_EQ(usual_task(bar, taken(Grip::kWritingTripod), kHand), UsualTask::kGrip);
  EXPECT_EQ(usual_task(bar, taken(Grip::kFixedHook), kHand), std::nullopt);
  EXPECT_EQ(usual_task(cylinder(90.0, 120.0), taken(Grip::kLargeDiameter), kHand),
            UsualTask::kHold);
  // As thick as a handle by its girth, but a hand doesn't meet round it: 8 x 72 mm.
  const product::Product phone = product::make_prism_product(
      {.width = 8.0, .depth = 72.0, .length = 150.0, .fillet_radius = 2.0});
  EXPECT_EQ(usual_task(phone, taken(Grip::kMediumWrap), kHand), UsualTask::kHold);
}

TEST(UsualTask, OfAComparisonIsOneForAll) {
  using Tasks = std::vector<std::optional<UsualTask>>;
  const auto hold = UsualTask::kHold;
  EXPECT_EQ(task_of_all(Tasks{hold, hold, std::nullopt}), UsualTask::kHold);
  EXPECT_EQ(task_of_all(Tasks{hold, UsualTask::kGrip}), UsualTask::kGrip);
  EXPECT_EQ(task_of_all(Tasks{std::nullopt}), UsualTask::kGrip);
}

}  // namespace
}  // namespace palmar::grasp
