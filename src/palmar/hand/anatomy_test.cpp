// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/anatomy.h"

#include <gtest/gtest.h>

namespace palmar::hand {
namespace {

TEST(Anatomy, EveryNameLeadsBackToItsValue) {
  for (int i = 0; i < kSegmentCount; ++i) {
    EXPECT_EQ(segment_named(name_of(static_cast<Segment>(i))), static_cast<Segment>(i));
  }
  for (int i = 0; i < kRegionCount; ++i) {
    EXPECT_EQ(region_named(name_of(static_cast<Region>(i))), static_cast<Region>(i));
  }
  for (int i = 0; i < kDofCount; ++i) {
    EXPECT_EQ(dof_named(name_of(static_cast<Dof>(i))), static_cast<Dof>(i));
  }
  for (int i = 0; i < kJointCount; ++i) {
    EXPECT_EQ(joint_named(name_of(static_cast<JointId>(i))), static_cast<JointId>(i));
  }
  for (int i = 0; i < kFingerCount; ++i) {
    EXPECT_EQ(finger_named(name_of(static_cast<Finger>(i))), static_cast<Finger>(i));
  }
  EXPECT_FALSE(region_named("thumb"));
}

TEST(Anatomy, NamesOfValuesMatchTheirEnumerators) {
  EXPECT_EQ(name_of(Segment::kRingMiddle), "ring_middle");
  EXPECT_EQ(name_of(Region::kUlnarPalm), "ulnar_palm");
  EXPECT_EQ(name_of(Region::kLittleDistal), "little_distal");
  EXPECT_EQ(name_of(Dof::kLittleDipFlexion), "little_dip_flexion");
  EXPECT_EQ(name_of(JointId::kMiddlePip), "middle_pip");
  EXPECT_EQ(name_of(Side::kLeft), "left");
}

TEST(Anatomy, PhalangesKnowFingerJointAndRegion) {
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    for (const auto& segment : segments_of(finger)) {
      if (!segment) continue;
      EXPECT_EQ(finger_of(*segment), finger);
      EXPECT_EQ(segment_of(*region_of(*segment)), *segment);
      EXPECT_EQ(name_of(*region_of(*segment)), name_of(*segment));
      EXPECT_TRUE(name_of(joint_of(*segment)).starts_with(name_of(finger)));
    }
  }
  EXPECT_EQ(joint_of(Segment::kThumbProximal), JointId::kThumbMp);
  EXPECT_EQ(joint_of(Segment::kIndexProximal), JointId::kIndexMcp);
  EXPECT_EQ(joint_of(Segment::kLittleDistal), JointId::kLittleDip);
  EXPECT_FALSE(finger_of(Segment::kPalm));
  EXPECT_EQ(segment_of(Region::kThenar), Segment::kPalm);
  EXPECT_FALSE(segment_of(Region::kDorsum));
}

}  // namespace
}  // namespace palmar::hand
