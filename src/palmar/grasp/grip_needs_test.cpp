// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/grip_needs.h"

#include <gtest/gtest.h>

namespace palmar::grasp {
namespace {

// What a grip needs is what the taxonomy's pictures show, not what the program found.

TEST(GripNeeds, RoundAThickHandleAWrapWithoutItsThumbIsNone) {
  const std::vector<hand::Region> fingers = {hand::Region::kIndexDistal,
                                             hand::Region::kMiddleDistal, hand::Region::kRingDistal,
                                             hand::Region::kCentralPalm};
  EXPECT_EQ(lacking_contact(Grip::kLargeDiameter, fingers),
            "the thumb doesn't touch it, which a large diameter needs");
  std::vector<hand::Region> all = fingers;
  all.push_back(hand::Region::kThumbDistal);
  EXPECT_EQ(lacking_contact(Grip::kLargeDiameter, all), "");
}

TEST(GripNeeds, TheBallOfTheThumbIsPalm) {
  EXPECT_EQ(
      lacking_contact(Grip::kLargeDiameter, {hand::Region::kThenar, hand::Region::kIndexDistal,
                                             hand::Region::kMiddleDistal}),
      "the thumb doesn't touch it, which a large diameter needs");
}

TEST(GripNeeds, WhereFingersComeRoundTheThumbMayLieOnThem) {
  for (const Grip grip : {Grip::kMediumWrap, Grip::kSmallDiameter}) {
    EXPECT_EQ(lacking_contact(grip, {hand::Region::kIndexDistal, hand::Region::kMiddleDistal}), "");
    EXPECT_NE(lacking_contact(grip, {hand::Region::kThumbDistal, hand::Region::kMiddleDistal}), "");
  }
}

TEST(GripNeeds, AHookNeedsNoThumb) {
  EXPECT_EQ(
      lacking_contact(Grip::kFixedHook, {hand::Region::kIndexMiddle, hand::Region::kMiddleMiddle}),
      "");
  EXPECT_EQ(
      lacking_contact(Grip::kFixedHook, {hand::Region::kIndexMiddle, hand::Region::kIndexDistal}),
      "only 1 finger besides the thumb touches it; a fixed hook needs 2");
}

TEST(GripNeeds, ATripodIsThreeFingers) {
  EXPECT_EQ(
      lacking_contact(Grip::kTripod, {hand::Region::kThumbDistal, hand::Region::kIndexDistal}),
      "the middle finger doesn't touch it, which a tripod needs");
  EXPECT_EQ(lacking_contact(Grip::kTripod, {hand::Region::kRingDistal}),
            "the thumb, index finger and middle finger don't touch it, which a tripod needs");
  EXPECT_EQ(lacking_contact(Grip::kTripod, {hand::Region::kThumbDistal, hand::Region::kIndexDistal,
                                            hand::Region::kMiddleDistal}),
            "");
}

TEST(GripNeeds, WithoutContactEveryGripLacksSomething) {
  for (int g = 0; g < kGripCount; ++g) {
    EXPECT_NE(lacking_contact(static_cast<Grip>(g), {}), "") << name_of(static_cast<Grip>(g));
  }
}

}  // namespace
}  // namespace palmar::grasp
