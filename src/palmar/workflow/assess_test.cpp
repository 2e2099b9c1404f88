// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/assess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numbers>
#include <set>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/study/assessment/error_budget.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar::workflow {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
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

TEST(AssessProducts, ErrorBudgetHoldsTheProductAgainAtTheSameGripForce) {
  AssessRequest request = request_for({handle(44.0)});
  request.rest.grip_force = 40.0;
  request.error_budget = true;
  const AssessOutcome outcome = assess_products(request);
  const std::shared_ptr<const study::ErrorBudget> budget = outcome.set.assessments.front().errors;
  ASSERT_NE(budget, nullptr);
  const auto area_of = [&](const std::string& changed) {
    for (const study::ErrorCase& one : budget->cases) {
      if (one.changed == changed) return one.area;
    }
    ADD_FAILURE() << changed << " is missing";
    return 0.0;
  };
  // Softer skin meets the same force with more of itself.
  EXPECT_GT(area_of("soft tissue"), budget->nominal.area);
  EXPECT_LT(area_of("stiff tissue"), budget->nominal.area);
  std::set<study::ErrorSource> sources;
  for (const study::ErrorCase& one : budget->cases) {
    sources.insert(one.source);
    // The hand of this test has no bones.
    if (one.source == study::ErrorSource::kBone) continue;
    EXPECT_EQ(one.failure, "") << one.changed;
    EXPECT_NEAR(one.grip_force, 40.0, one.source == study::ErrorSource::kMesh ? 6.0 : 0.8)
        << one.changed;
  }
  EXPECT_EQ(sources.size(), 5U);
}

TEST(AssessProducts, ForcesOnAHeldProductAddUpToNothing) {
  AssessRequest request = request_for({handle(44.0)});
  request.friction.weight = 6.0;
  request.rest.grip_force = 40.0;
  const AssessOutcome outcome = assess_products(request);

  ASSERT_EQ(outcome.set.assessments.size(), 1U);
  EXPECT_TRUE(outcome.has_converged);
  EXPECT_EQ(outcome.folder, "");
  const study::Assessment& held = outcome.set.assessments.front().assessment;
  ASSERT_EQ(held.balance.status, grasp::BalanceStatus::kBalanced);
  EXPECT_NEAR(held.balance.grip_force, 40.0, 0.8);  // N; settling ends within 2 % of it
  Vec3 sum = held.contact.total.force_vector - 6.0 * Vec3::UnitZ();
  for (const Vec3& force : held.balance.friction_force) sum += force;
  // N; 1 % of the grip force counts as balanced, and normal forces are told along the way to the
  // nearest point, not along the mean direction in which they press.
  EXPECT_LT(sum.norm(), 0.6);
}

TEST(AssessProducts, ThoroughDesignsAreComparedAtOneGripForce) {
  product::PrismProductOptions prism;
  prism.width = 40.0;
  prism.depth = 30.0;
  prism.length = 140.0;
  prism.fillet_radius = 5.0;
  AssessRequest request =
      request_for({handle(30.0), handle(45.0), product::make_prism_product(prism)});
  // 25 % of the mean of 53.0 and 34.1 kg (Steiber 2016, men and women of 45 to 49 years).
  const double usual = 0.25 * 0.5 * (53.0 + 34.1) * 9.80665;
  const AssessOutcome same = assess_products(request);
  for (const study::AssessedProduct& one : same.set.assessments) {
    const study::Assessment& held = one.assessment;
    EXPECT_EQ(held.balance.status, grasp::BalanceStatus::kBalanced) << held.balance.message;
    EXPECT_NEAR(study::grip_force_of(one), usual, 0.01 * usual) << one.product.name;  // N
    EXPECT_THAT(held.options.balance.asked_words(held.grasp.grip),
                HasSubstr("women and men of 45 years"));
  }
  // The thesis' way each is held as firmly as its shape made the closing.
  request.rest.limit_depths = true;
  const AssessOutcome own = assess_products(request);
  double least = 1e9, most = 0.0;
  for (const study::AssessedProduct& one : own.set.assessments) {
    EXPECT_FALSE(one.assessment.options.balance.asked_grip_force(one.assessment.grasp.grip));
    least = std::min(least, study::grip_force_of(one));
    most = std::max(most, study::grip_force_of(one));
  }
  EXPECT_GT(most, 1.05 * least);
}

TEST(AssessProducts, HeaviestDesignDecidesHowFirmlyAllAreHeld) {
  AssessRequest request = request_for({handle(30.0), handle(45.0)});
  request.friction.density = 20.0;  // g/cm^3: gold
  request.friction.friction = 0.2;
  std::vector<std::string> notes;
  request.note = [&](const std::string& text) { notes.push_back(text); };
  const AssessOutcome outcome = assess_products(request);
  // pi/4 x 4.5^2 x 14 cm^3 of it; 1.4 times what two sides hold by friction. The mesh lies inside
  // the cylinder by up to 0.1 mm.
  const double weight = std::numbers::pi / 4.0 * 4.5 * 4.5 * 14.0 * 20e-3 * 9.80665;
  ASSERT_EQ(outcome.set.assessments.size(), 2U);
  for (const study::AssessedProduct& one : outcome.set.assessments) {
    const auto asked = one.assessment.options.balance.asked_grip_force(one.assessment.grasp.grip);
    EXPECT_NEAR(asked.value_or(0.0), 1.4 * weight / 0.4, 0.01 * 1.4 * weight / 0.4);
  }
  EXPECT_THAT(notes, Contains(AllOf(HasSubstr("raised from 107 N"),
                                    HasSubstr("of " + handle(45.0).name + " by friction"))));
}

TEST(AssessProducts, ForceThatTheHandDoesNotReachIsSaid) {
  AssessRequest request = request_for({handle(40.0)});
  request.rest.grip_force = 1500.0;  // N; the strongest grip measured is below 1000 N
  const AssessOutcome outcome = assess_products(request);
  const grasp::Balance& balance = outcome.set.assessments.front().assessment.balance;
  EXPECT_LT(balance.grip_force, 1400.0);
  if (balance.status == grasp::BalanceStatus::kBalanced) {
    EXPECT_THAT(balance.message, HasSubstr("1500 N were requested, which the hand doesn't reach"));
  } else {
    EXPECT_THAT(balance.message, Not(testing::IsEmpty()));
  }
}

TEST(AssessProducts, ValueIsAssessedAsTheFileItCameFrom) {
  const TemporaryFolder folder;
  const std::string path = (folder / "handle.obj").string();
  formats::write_mesh(path, handle(50.0).mesh);
  const ProductChoice file(path, {.unit = geometry::LengthUnit::kMillimetre});

  const AssessOutcome of_file = assess_products(request_for({file}));
  const AssessOutcome of_value = assess_products(request_for({load_product(file)}));

  const study::Assessment& a = of_file.set.assessments.front().assessment;
  const study::Assessment& b = of_value.set.assessments.front().assessment;
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

TEST(AssessProducts, SensorsBearTheForceOfTheContact) {
  for (const char* layout : {"mat", "glove"}) {
    AssessRequest request = request_for({handle(44.0)});
    request.sensors = layout;
    const AssessOutcome outcome = assess_products(request);
    const study::Assessment& held = outcome.set.assessments.front().assessment;
    ASSERT_TRUE(held.sensors);
    const double force = held.contact.total.force;
    EXPECT_NEAR(held.sensors->force + held.sensors->force_beside, force, 1e-9 * force) << layout;
    // The mat goes round all of the handle; hands are wider than a glove's patches.
    EXPECT_GT(held.sensors->force, (layout == std::string("mat") ? 0.98 : 0.6) * force) << layout;
    // No cell of 25 mm^2 has more than the largest mean over discs of 24.
    EXPECT_LT(held.sensors->peak_pressure, 1.5 * held.contact.total.peak_pressure_cells);
    EXPECT_GT(held.sensors->peak_pressure, 0.6 * held.contact.total.peak_pressure_cells);
  }
}

TEST(AssessProducts, MeasuredPressureStandsBesideTheSimulation) {
  // What the sensor itself would show, as measurement: nothing differs.
  const TemporaryFolder folder;
  AssessRequest request = request_for({handle(44.0)});
  request.sensors = "mat";
  request.pictures = false;
  request.out = (folder / "first").string();
  const AssessOutcome first = assess_products(request);
  request.measured = request.out + "/sensors.csv";
  request.out = (folder / "second").string();
  const AssessOutcome second = assess_products(request);
  const study::Assessment& held = second.set.assessments.front().assessment;
  ASSERT_TRUE(held.measured);
  EXPECT_NEAR(held.measured->pearson.r, 1.0, 1e-9);
  EXPECT_NEAR(held.measured->rms, 0.0, 1e-12);
  EXPECT_NEAR(held.measured->force_measured, held.measured->force_simulated, 1e-9);
  const std::string page = formats::read_file(folder / "second" / "report.html");
  EXPECT_THAT(page, HasSubstr("Sensors between hand and product"));
  EXPECT_THAT(page, HasSubstr("Simulated less measured"));
  EXPECT_THAT(formats::read_file(folder / "second" / "assessment.json"),
              HasSubstr("\"cell_force_n\""));
  EXPECT_THAT(formats::read_file(folder / "second" / "sensors.csv"), HasSubstr("measured_force_n"));
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
}  // namespace palmar::workflow
