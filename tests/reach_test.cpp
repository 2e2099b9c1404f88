// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Buttons under the template hand's fingers.
#include "palmar/grasp/precision/reach.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/product/primitives.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

constexpr double kDegrees = std::numbers::pi / 180.0;

class Reach : public TemplateTest {
 protected:
  static const product::Product& bar() {
    static const product::Product made = [] {
      product::CylinderProductOptions options;
      options.diameter = 18.0;
      options.length = 110.0;
      return product::make_cylinder_product(options);
    }();
    return made;
  }
  static const grasp::Grasp& held() {
    static const grasp::Grasp made = [] {
      grasp::PrecisionGripOptions options;
      options.grip = grasp::Grip::kTripod;
      return grasp::close_precision_grip(hand(), bar(), options);
    }();
    return made;
  }
  static std::vector<grasp::ButtonReach> press(const hand::Hand& by, const Vec3& point) {
    return grasp::reach_buttons(by, bar(), held(), {{"button", point, Vec3::Zero()}});
  }
};

grasp::TouchingSegment touch(hand::Segment segment, const Vec3& normal) {
  return {segment, Vec3::Zero(), normal, 1.0};
}

TEST(GripKept, NeedsTwoOpposedPartsOfTheHandAndOneBehind) {
  const Vec3 push(0.0, 0.0, -1.0);  // into a surface that faces +z
  const std::vector<grasp::TouchingSegment> pinch = {
      touch(hand::Segment::kThumbDistal, {0, 0, -1}), touch(hand::Segment::kIndexDistal, {0, 0, 1}),
      touch(hand::Segment::kMiddleDistal, {0, 0, 1})};
  EXPECT_TRUE(grasp::is_grip_kept_without(hand::Finger::kIndex, pinch, push));
  EXPECT_FALSE(grasp::is_grip_kept_without(hand::Finger::kThumb, pinch, push));  // nothing opposes
  const std::vector<grasp::TouchingSegment> two = {touch(hand::Segment::kThumbDistal, {0, 0, -1}),
                                                   touch(hand::Segment::kIndexDistal, {0, 0, 1})};
  EXPECT_FALSE(grasp::is_grip_kept_without(hand::Finger::kIndex, two, push));
  EXPECT_TRUE(grasp::is_grip_kept_without(hand::Finger::kRing, two, push));
  // Normals 90 degrees apart hold nothing.
  const std::vector<grasp::TouchingSegment> corner = {
      touch(hand::Segment::kThumbDistal, {1, 0, 0}), touch(hand::Segment::kIndexDistal, {0, 0, 1})};
  EXPECT_FALSE(grasp::is_grip_kept_without(hand::Finger::kRing, corner, push));
  EXPECT_FALSE(grasp::is_grip_kept_without(hand::Finger::kRing, {}, push));
}

TEST_F(Reach, FingerPressesWhereItAlreadyIs) {
  const grasp::FingertipContact& index = held().fingertips[1];
  ASSERT_EQ(index.finger, hand::Finger::kIndex);
  const std::vector<grasp::ButtonReach> reach = press(hand(), index.target);
  ASSERT_EQ(reach.size(), 1u);
  ASSERT_EQ(reach[0].fingers.size(), 5u);
  const grasp::FingerReach& own = reach[0].fingers[1];
  EXPECT_TRUE(own.is_reached);
  EXPECT_LT(own.miss, 1.0);
  EXPECT_TRUE(own.is_grip_kept);  // thumb and middle finger hold
  EXPECT_GT(own.margin, 0.0);
  EXPECT_EQ(reach[0].best, hand::Finger::kIndex) << reach[0].message;
  // Only the moving finger's joints have changed.
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    if (dof >= hand::Dof::kIndexMcpFlexion && dof <= hand::Dof::kIndexDipFlexion) continue;
    EXPECT_EQ(own.posture[dof], held().posture[dof]) << name_of(dof);
  }
}

TEST_F(Reach, ThumbOfATripodCannotLeaveIt) {
  const std::vector<grasp::ButtonReach> reach = press(hand(), held().fingertips[0].target);
  EXPECT_TRUE(reach[0].fingers[0].is_reached);
  EXPECT_FALSE(reach[0].fingers[0].is_grip_kept);
  EXPECT_NE(reach[0].best, hand::Finger::kThumb);
}

TEST_F(Reach, FarButtonIsMissedByAStatedDistance) {
  const Vec3 far(0.0, 9.0, held().grip_point.z() > 0.0 ? -54.0 : 54.0);
  const std::vector<grasp::ButtonReach> reach = press(hand(), far);
  EXPECT_FALSE(reach[0].best) << reach[0].message;
  EXPECT_THAT(reach[0].message, HasSubstr("misses it by"));
}

TEST_F(Reach, LessJointRangeNeverImprovesReach) {
  // Points along the bar and round it; ranges shrunk towards the grasp's own angles.
  for (const double share : {0.5, 0.1}) {
    hand::Hand stiff = hand();
    for (hand::Joint& joint : stiff.skeleton.joints) {
      for (hand::JointDof& dof : joint.dofs) {
        // The thumb's limit postures belong to its range: shrinking that would move them.
        if (dof.dof == hand::Dof::kThumbCmcFlexion || dof.dof == hand::Dof::kThumbCmcAbduction)
          continue;
        const double q = held().posture[dof.dof];
        dof.lower = q + share * (dof.lower - q);
        dof.upper = q + share * (dof.upper - q);
      }
    }
    int reached_free = 0, reached_stiff = 0;
    for (int i = 0; i < 36; ++i) {
      const double angle = 70.0 * kDegrees * i, along = held().grip_point.z() + 7.0 * (i % 9 - 4);
      const Vec3 point(9.0 * std::cos(angle), 9.0 * std::sin(angle), along);
      const grasp::ButtonReach wide = press(hand(), point)[0], narrow = press(stiff, point)[0];
      for (std::size_t f = 0; f < 5; ++f) {
        SCOPED_TRACE(std::to_string(i) + " " + std::string(name_of(static_cast<hand::Finger>(f))));
        reached_free += wide.fingers[f].is_reached ? 1 : 0;
        reached_stiff += narrow.fingers[f].is_reached ? 1 : 0;
        if (narrow.fingers[f].is_reached) {
          EXPECT_TRUE(wide.fingers[f].is_reached);
        }
        // Half a tenth: both balance reaching against comfort.
        if (wide.fingers[f].miss < 40.0) {
          EXPECT_LE(wide.fingers[f].miss, narrow.fingers[f].miss + 0.1);
        }
      }
    }
    EXPECT_GE(reached_free, reached_stiff);
    if (share < 0.2) {
      EXPECT_GT(reached_free, reached_stiff);
    }
  }
}

TEST_F(Reach, ButtonOffTheSurfaceIsRefusedByName) {
  try {
    grasp::reach_buttons(hand(), bar(), held(), {{"trigger", {0.0, 15.0, 0.0}, Vec3::Zero()}});
    FAIL() << "no error";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("button \"trigger\" (0, 15, 0 mm) is 6.0 mm off"));
  }
}

TEST_F(Reach, MapHasAValueForEveryVertex) {
  const grasp::ReachMap map = grasp::map_reach(hand(), bar(), held(), 60);
  ASSERT_EQ(map.finger.size(), bar().mesh.vertices.size());
  ASSERT_EQ(map.margin.size(), map.finger.size());
  ASSERT_EQ(map.miss.size(), map.finger.size());
  EXPECT_GT(map.reached_area, 0.0);
  for (std::size_t v = 0; v < map.finger.size(); ++v) {
    if (map.finger[v] < 0) continue;
    EXPECT_EQ(map.miss[v], 0.0);
    EXPECT_NE(map.finger[v], 0);  // the thumb of a tripod stays
  }
  EXPECT_THROW(grasp::map_reach(hand(), bar(), held(), 0), UsageError);
}

}  // namespace
}  // namespace palmar::tests
