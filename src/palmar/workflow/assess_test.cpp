// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/assess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar {
namespace {

using testing::HasSubstr;
using workflow_test::coarse_hand;
using workflow_test::handle;
using workflow_test::TemporaryFolder;

AssessRequest request_for(std::vector<ProductChoice> products) {
  AssessRequest request;
  request.products = std::move(products);
  request.hand.value = coarse_hand();
  request.contact.error_band = false;
  return request;
}

std::string refusal(const AssessRequest& request) {
  try {
    request.check();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(AssessProducts, ForcesOnAHeldProductAddUpToNothing) {
  AssessRequest request = request_for({handle(44.0)});
  request.friction.weight = 6.0;
  request.rest.grip_force = 40.0;
  const AssessOutcome outcome = assess_products(request);

  ASSERT_EQ(outcome.set.assessments.size(), 1U);
  EXPECT_TRUE(outcome.has_converged);
  EXPECT_EQ(outcome.folder, "");
  const Assessment& held = outcome.set.assessments.front().assessment;
  ASSERT_EQ(held.balance.status, BalanceStatus::kBalanced);
  EXPECT_NEAR(held.balance.grip_force, 40.0, 0.8);  // N; settling ends within 2 % of it
  Vec3 sum = held.contact.total.force_vector - 6.0 * Vec3::UnitZ();
  for (const Vec3& force : held.balance.friction_force) sum += force;
  EXPECT_LT(sum.norm(), 0.4);  // N; 1 % of the grip force counts as balanced
}

TEST(AssessProducts, ValueIsAssessedAsTheFileItCameFrom) {
  const TemporaryFolder folder;
  const std::string path = (folder / "handle.obj").string();
  write_mesh(path, handle(50.0).mesh);
  const ProductChoice file(path, {.unit = LengthUnit::kMillimetre});

  const AssessOutcome of_file = assess_products(request_for({file}));
  const AssessOutcome of_value = assess_products(request_for({load_product(file)}));

  const Assessment& a = of_file.set.assessments.front().assessment;
  const Assessment& b = of_value.set.assessments.front().assessment;
  EXPECT_GT(a.contact.total.force, 1.0);  // N
  EXPECT_EQ(a.contact.total.force, b.contact.total.force);
  EXPECT_EQ(a.contact.pressure, b.contact.pressure);
  EXPECT_EQ(a.grasp.posture.angle, b.grasp.posture.angle);
}

TEST(AssessProducts, CancelledAfterTheFirstProductKeepsIt) {
  const TemporaryFolder folder;
  AssessRequest request = request_for({handle(40.0), handle(52.0)});
  request.out = (folder / "report").string();
  std::atomic<bool> cancel = false;
  const std::string second = handle(52.0).name;
  const Progress progress{.report =
                              [&](double, const std::string& activity) {
                                if (activity.rfind(second, 0) == 0) cancel = true;
                              },
                          .cancel = &cancel};
  const AssessOutcome outcome = assess_products(request, progress);

  EXPECT_TRUE(outcome.is_cancelled);
  EXPECT_EQ(outcome.asked, 2U);
  ASSERT_EQ(outcome.set.assessments.size(), 1U);
  EXPECT_EQ(outcome.set.assessments.front().product.name, handle(40.0).name);
  EXPECT_TRUE(std::filesystem::exists(folder / "report" / "report.html"));
}

TEST(AssessProducts, CancelledBeforeTheFirstIsFinishedWritesNothing) {
  const TemporaryFolder folder;
  AssessRequest request = request_for({handle(40.0)});
  request.out = (folder / "report").string();
  const std::atomic<bool> cancel = true;
  EXPECT_THROW(assess_products(request, {.report = {}, .cancel = &cancel}), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(folder / "report"));
}

TEST(AssessProducts, EveryProductIsReadBeforeTheFirstIsGrasped) {
  bool has_begun = false;
  const Progress progress{.report = [&](double, const std::string&) { has_begun = true; },
                          .cancel = nullptr};
  try {
    assess_products(request_for({handle(40.0), ProductChoice("nowhere/mug.stl")}), progress);
    FAIL() << "a product was read from nowhere";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere/mug.stl"));
  }
  EXPECT_FALSE(has_begun);
}

TEST(AssessProducts, HandThatIsNotThereIsNamed) {
  AssessRequest request = request_for({handle(40.0)});
  request.hand = {.name = "nowhere/her.hand.glb", .tissue = "", .value = nullptr};
  try {
    assess_products(request);
    FAIL() << "a hand was read from nowhere";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere/her.hand.glb"));
  }
}

TEST(AssessRequest, CheckNamesFieldValueAndWhatIsAllowed) {
  EXPECT_THAT(refusal(request_for({})), HasSubstr("setting \"products\": none is given"));
  EXPECT_THAT(refusal(request_for({ProductChoice()})), HasSubstr("a file or a value is required"));
  AssessRequest request = request_for({handle(40.0)});
  EXPECT_EQ(refusal(request), "accepted");
  request.friction.friction = 7.0;
  EXPECT_THAT(refusal(request), HasSubstr("setting \"friction\" is 7; 0 to 5 is required"));
  request = request_for({handle(40.0)});
  request.rest.grip_force = -3.0;
  EXPECT_THAT(refusal(request), HasSubstr("grip force is -3 N; more than 0"));
  request = request_for({handle(40.0)});
  request.grasp.palm_limit_depth = -1.0;
  EXPECT_THAT(refusal(request), HasSubstr("-1"));
}

}  // namespace
}  // namespace palmar
