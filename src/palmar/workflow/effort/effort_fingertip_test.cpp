// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort_fingertip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "palmar/core/error.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar::workflow {
namespace {

using testing::HasSubstr;
using workflow_test::coarse_hand;

constexpr double kDegree = std::numbers::pi / 180.0;  // rad

/// The middle finger bent as in Synek et al. 2019.
FingertipRequest bent_middle_finger() {
  FingertipRequest request;
  request.hand.value = coarse_hand();
  request.finger = hand::Finger::kMiddle;
  request.posture = {{hand::Dof::kMiddleMcpFlexion, 40 * kDegree},
                     {hand::Dof::kMiddlePipFlexion, 55 * kDegree},
                     {hand::Dof::kMiddleDipFlexion, 35 * kDegree}};
  return request;
}

std::string refused(const FingertipRequest& request) {
  try {
    fingertip_forces(request);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FingertipForces, AllButTheExtensorBendTheKnuckle) {
  // Anatomy: lumbrical and interossei bend the MCP while they straighten PIP and DIP.
  const FingertipOutcome outcome = fingertip_forces(bent_middle_finger());
  ASSERT_EQ(outcome.forces.size(), 6U);
  for (const effort::FingertipForce& tip : outcome.forces) {
    ASSERT_EQ(tip.dof[0], hand::Dof::kMiddleMcpFlexion);
    ASSERT_EQ(tip.dof[3], hand::Dof::kMiddleDipFlexion);
    const bool is_extensor = tip.tendon == hand::Tendon::kEdc;
    EXPECT_EQ(tip.moment_arm[0] < 0.0, is_extensor) << name_of(tip.tendon);
    const bool is_flexor = tip.tendon == hand::Tendon::kFdp || tip.tendon == hand::Tendon::kFds;
    if (is_flexor) continue;
    EXPECT_LT(tip.moment_arm[3], 0.0) << name_of(tip.tendon);
  }
}

TEST(FingertipForces, GrowWithTheTendonForce) {
  FingertipRequest request = bent_middle_finger();
  request.tendons = {hand::Tendon::kFdp};
  const effort::FingertipForce once = fingertip_forces(request).forces.at(0);
  request.force = 7.0;
  const effort::FingertipForce seven = fingertip_forces(request).forces.at(0);
  EXPECT_LT((seven.force - 7.0 * once.force).norm(), 1e-9);  // N; rounding
}

TEST(FingertipForces, OnlyTheNamedAnglesBend) {
  const FingertipOutcome outcome = fingertip_forces(bent_middle_finger());
  EXPECT_EQ(outcome.posture[hand::Dof::kMiddlePipFlexion], 55 * kDegree);
  EXPECT_EQ(outcome.posture[hand::Dof::kMiddleMcpAbduction], 0.0);
}

TEST(FingertipForces, WhatTheFingerDoesNotHaveIsNamed) {
  FingertipRequest request = bent_middle_finger();
  request.force = 0.0;
  EXPECT_EQ(refused(request), "setting \"force\" is 0; above 0 and at most 1000 N is allowed");
  request = bent_middle_finger();
  request.tendons = {hand::Tendon::kFpl};
  EXPECT_THAT(refused(request), HasSubstr("the middle has no tendon \"fpl\"; it has fdp"));
  request = bent_middle_finger();
  request.posture = {{hand::Dof::kIndexPipFlexion, 0.5}};
  EXPECT_THAT(refused(request), HasSubstr("index PIP flexion is no angle of the middle"));
  request.posture = {{hand::Dof::kMiddleMcpFlexion, 140 * kDegree}};
  EXPECT_THAT(refused(request),
              HasSubstr("setting \"posture\": mcp is 140 deg; the range of middle MCP flexion is"));
}

}  // namespace
}  // namespace palmar::workflow
