// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/grasp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/workflow/effort/effort.h"
#include "palmar/workflow/grasp/grasp_evaluate.h"
#include "palmar/workflow/grasp/grasp_reach.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar::workflow {
namespace {

using testing::HasSubstr;
using workflow_test::coarse_hand;
using workflow_test::handle;
using workflow_test::TemporaryFolder;

GraspRequest request_for(const product::Product& product) {
  GraspRequest request;
  request.product = product;
  request.hand.value = coarse_hand();
  return request;
}

TEST(GraspProduct, WrittenGraspIsReadBackAsTheSame) {
  const TemporaryFolder folder;
  GraspRequest request = request_for(handle(44.0));
  const grasp::Grasp found = grasp_product(request).grasp;
  EXPECT_EQ(found.status, grasp::GraspStatus::kHeld);
  request.grasp_file = (folder / "grasp.json").string();
  formats::write_file(request.grasp_file, records::grasp_json(found));
  const grasp::Grasp given = grasp_product(request).grasp;
  for (std::size_t d = 0; d < found.posture.angle.size(); ++d) {
    EXPECT_NEAR(given.posture.angle[d], found.posture.angle[d], 1e-9);  // rad; through degrees
  }
  EXPECT_TRUE(
      given.product_from_hand.translation.isApprox(found.product_from_hand.translation, 1e-9));
  EXPECT_EQ(given.grip, found.grip);
}

TEST(GraspProduct, FingertipsGoWithPrecisionGripsOnly) {
  GraspRequest request = request_for(handle(44.0));
  request.grasp.fingertips = {{hand::Finger::kThumb, Vec3(22.0, 0.0, 0.0)}};
  try {
    grasp_product(request);
    FAIL() << "a power grip took a fingertip's place";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("setting \"fingertips\": grip power holds with the whole hand"));
  }
}

TEST(ReachOfGrasp, WithoutAButtonOrAMapThereIsNothingToDo) {
  ReachRequest request;
  request.grasp = request_for(handle(44.0));
  EXPECT_THROW(reach_of_grasp(request), UsageError);
}

TEST(EvaluateGrasp, HandFarFromTheProductTouchesNothing) {
  const TemporaryFolder folder;
  EvaluateRequest request;
  request.product = handle(44.0);
  request.hand.value = coarse_hand();
  request.posture_file = (folder / "flat.json").string();
  formats::write_file(request.posture_file, R"({"index_pip_flexion_deg": 20})");
  try {
    evaluate_grasp(request);
    FAIL() << "a posture alone says where the product is";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("setting \"measured from product\" is needed"));
  }
  request.product_from_hand = geometry::Rigid3{Quat::Identity(), Vec3(0.0, 0.0, 1000.0)};
  const EvaluateOutcome outcome = evaluate_grasp(request);
  EXPECT_EQ(outcome.set.assessments.front().assessment.contact.status,
            contact::ContactStatus::kNoContact);
  EXPECT_TRUE(outcome.has_converged);
}

TEST(EffortOfGrasp, JointsOfAHeldHandAreInBalance) {
  EffortRequest request;
  request.product = handle(44.0);
  request.hand.value = coarse_hand();
  const effort::EffortResult effort = effort_of_grasp(request);
  EXPECT_GT(effort.contact_force, 1.0);  // N
  for (const effort::DigitEffort& digit : effort.digits) {
    if (digit.status == effort::EffortStatus::kNoLoad) continue;
    for (const effort::JointEffort& joint : digit.joints) {
      const double sum = joint.external + joint.muscles + joint.stop + joint.missing;
      EXPECT_NEAR(sum, 0.0, 1e-6 * (1.0 + std::abs(joint.external)));  // N mm; rounding
    }
  }
}

}  // namespace
}  // namespace palmar::workflow
