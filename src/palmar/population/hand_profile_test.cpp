// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/hand_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/hand/posture/named_postures.h"

namespace palmar::population {
namespace {

using ::testing::HasSubstr;

// A skeleton of joints on a line with uneven ranges; the thumb's limit postures turn about two
// axes. Enough for named postures and posing.
hand::Hand simple_hand() {
  hand::Hand hand;
  int d = 0;
  for (int j = 0; j < hand::kJointCount; ++j) {
    hand::Joint& joint = hand.skeleton.joints[j];
    joint.id = static_cast<hand::JointId>(j);
    joint.centre = Vec3(0.0, 5.0 * j, 0.0);
    // Wrist 3, thumb CMC 2, the thumb's others 1, then MCP 2, PIP 1, DIP 1 of every finger.
    const bool is_mcp = j >= 4 && (j - 4) % 3 == 0;
    const int count = j == 0 ? 3 : (j == 1 || is_mcp ? 2 : 1);
    for (int k = 0; k < count; ++k, ++d) {
      hand::JointDof dof;
      dof.dof = static_cast<hand::Dof>(d);
      dof.axis = d % 2 == 0 ? Vec3::UnitX() : Vec3::UnitZ();
      dof.centre = joint.centre;
      dof.lower = -0.4 - 0.01 * d;
      dof.upper = 1.2 + 0.02 * d;
      dof.reference = 0.05;
      joint.dofs.push_back(dof);
    }
  }
  const auto turn = [](double angle, const Vec3& axis, const Vec3& t) {
    return hand::CmcLimit{Quat(Eigen::AngleAxisd(angle, axis)), t};
  };
  hand.skeleton.thumb_cmc = {.flexion = turn(0.5, Vec3::UnitY(), Vec3(1.0, 0.0, 2.0)),
                             .extension = turn(0.4, -Vec3::UnitY(), Vec3(-1.0, 0.5, 0.0)),
                             .abduction = turn(0.9, Vec3::UnitX(), Vec3(0.0, 2.0, -1.0)),
                             .adduction = turn(0.2, -Vec3::UnitX(), Vec3(0.3, 0.0, 0.0))};
  return hand;
}

double distance(const geometry::Rigid3& a, const geometry::Rigid3& b) {
  double largest = 0.0;
  for (const Vec3& p : {Vec3(0.0, 0.0, 0.0), Vec3(50.0, 0.0, 0.0), Vec3(0.0, 50.0, 20.0)}) {
    largest = std::max(largest, (a * p - b * p).norm());
  }
  return largest;
}

TEST(WithRangeShare, NarrowsEveryRangeAboutTheRelaxedPosture) {
  const hand::Hand hand = simple_hand();
  const hand::Posture relaxed = hand::named_posture(hand.skeleton, "relaxed").value();
  const hand::Hand reduced = with_range_share(hand, 0.6);
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    const hand::JointDof& before = hand.skeleton.dof(dof);
    const hand::JointDof& after = reduced.skeleton.dof(dof);
    EXPECT_NEAR(after.upper - after.lower, 0.6 * (before.upper - before.lower), 1e-12);
    EXPECT_NEAR(after.upper - relaxed[dof], 0.6 * (before.upper - relaxed[dof]), 1e-12);
    EXPECT_EQ(after.reference, before.reference);
  }
}

// Whatever the narrower hand can do looks as on the whole one, the thumb included, whose posture is
// reported in shares of its limits.
TEST(WithRangeShare, PosesAsTheWholeHandWithinTheNarrowRange) {
  const hand::Hand hand = simple_hand();
  RandomStream random(1, 0);
  for (const double share : {0.9, 0.56, 0.1}) {
    const hand::Hand reduced = with_range_share(hand, share);
    for (int k = 0; k < 50; ++k) {
      hand::Posture posture;
      for (int d = 0; d < hand::kDofCount; ++d) {
        const hand::JointDof& dof = reduced.skeleton.dof(static_cast<hand::Dof>(d));
        posture[dof.dof] = dof.lower + random.uniform() * (dof.upper - dof.lower);
      }
      const hand::PosedSkeleton whole = hand::pose_skeleton(hand.skeleton, posture);
      const hand::PosedSkeleton narrow = hand::pose_skeleton(reduced.skeleton, posture);
      EXPECT_LT(distance(whole.thumb_metacarpal, narrow.thumb_metacarpal), 1e-9);  // mm; rounding
      for (int s = 0; s < hand::kSegmentCount; ++s) {
        EXPECT_LT(distance(whole.segment[s], narrow.segment[s]), 1e-9);
      }
    }
  }
}

TEST(WithRangeShare, OfOneChangesNothingAndOfNothingIsRefused) {
  const hand::Hand hand = simple_hand();
  const hand::Hand same = with_range_share(hand, 1.0);
  EXPECT_EQ(same.skeleton.dof(hand::Dof::kIndexPipFlexion).upper,
            hand.skeleton.dof(hand::Dof::kIndexPipFlexion).upper);
  try {
    with_range_share(hand, 0.0);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("share of the range of motion is 0; above 0 to 1"));
  }
}

TEST(HandProfile, BuiltInOnesAreSoundAndReportTheirSources) {
  EXPECT_EQ(built_in_profiles().front().name, "none");
  for (const HandProfile& profile : built_in_profiles()) {
    EXPECT_NO_THROW(profile.check());
    EXPECT_FALSE(profile.source.empty());
  }
}

TEST(HandProfile, RefusesWithFieldValueAndRange) {
  HandProfile profile;
  profile.range_share = 1.2;
  try {
    profile.check();
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("profile \"none\": range_share is 1.2; above 0 to 1"));
  }
  try {
    profile_named("thick_glove");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean thick_gloves?"));
  }
}

TEST(WithProfile, ScalesSizeAndStrengthOfAPerson) {
  HandSample sample;
  sample.dimensions = {{{hand::DimensionKind::kHandLength}, 200.0}};
  sample.grip_strength = 500.0;
  const HandSample child = with_profile(sample, profile_named("child_10"));
  EXPECT_DOUBLE_EQ(child.dimensions[0].value, 156.0);
  EXPECT_DOUBLE_EQ(child.grip_strength, 155.0);
}

}  // namespace
}  // namespace palmar::population
