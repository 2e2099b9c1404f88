// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/skin/skinning.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using TemplateScale = TemplateTest;

TEST_F(TemplateScale, PosedSkinAndBonesScaleWithTheHand) {
  const double factor = 1.3;
  const hand::Hand large = hand::scaled(hand(), factor);
  hand::Posture posture = hand::reference_posture(hand().skeleton);
  for (int d = 3; d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = hand().skeleton.dof(static_cast<hand::Dof>(d));
    posture[dof.dof] = 0.3 * dof.lower + 0.7 * dof.upper;
  }
  const std::vector<Vec3> small_skin = hand::pose_skin(hand(), posture);
  const std::vector<Vec3> large_skin = hand::pose_skin(large, posture);
  for (std::size_t v = 0; v < small_skin.size(); ++v) {
    ASSERT_LT((large_skin[v] - factor * small_skin[v]).norm(), 1e-9) << "vertex " << v;
  }
  const auto small_bones = hand::pose_bones(hand(), posture),
             large_bones = hand::pose_bones(large, posture);
  for (std::size_t b = 0; b < small_bones.size(); ++b) {
    for (std::size_t v = 0; v < small_bones[b].vertices.size(); ++v) {
      const Vec3 expected = factor * small_bones[b].vertices[v];
      ASSERT_LT((large_bones[b].vertices[v] - expected).norm(), 1e-9) << hand().bones[b].name;
    }
  }
}

TEST_F(TemplateScale, DimensionsKeptAreThoseThatTheSkinHas) {
  const hand::Hand small = hand::scaled(hand(), 0.9);
  const hand::HandDimensions measured = hand::measure_hand(small);
  EXPECT_NEAR(small.dimensions.hand_length, measured.hand_length, 1e-6);
  EXPECT_NEAR(small.dimensions.hand_circumference, measured.hand_circumference, 1e-6);
  for (std::size_t s = 0; s < measured.segment.size(); ++s) {
    // Where along the segment is measured does not scale exactly: 0.1 % of a finger.
    EXPECT_NEAR(small.dimensions.segment[s].width, measured.segment[s].width, 0.02);  // mm
  }
}

TEST_F(TemplateScale, FactorOutOfRangeIsRefused) {
  EXPECT_THROW(hand::scaled(hand(), 0.0), UsageError);
  EXPECT_THROW(hand::scaled(hand(), std::nan("")), UsageError);
}

}  // namespace
}  // namespace palmar::tests
