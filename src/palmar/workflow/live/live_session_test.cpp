// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/live/live_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/workflow/assess.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar::workflow {
namespace {

using workflow_test::coarse_hand;
using workflow_test::handle;

/// With a hand that isn't the built-in one and searches by itself.
LiveSession session_with(const product::Product& product) {
  HandChoice choice;
  choice.value = coarse_hand();
  LiveHand hand = prepare_live_hand(choice, contact::ContactModel{});
  hand.reference = hand.hand;
  return {hand, std::make_shared<const product::Product>(product)};
}

LiveTask task_of(double grip_force) {
  LiveTask task;
  task.rest.grip_force = grip_force;
  return task;
}

/// Without what differs from run to run: times, and the command line.
std::string comparable(const study::AssessmentSet& set) {
  study::AssessmentSet same = set;
  same.command_line.clear();
  for (study::AssessedProduct& one : same.assessments) {
    one.assessment.times = {};
    one.assessment.certainty.reset();  // a session is too quick to look for it
  }
  return records::assessment_json(same);
}

/// A handle of 40 mm, gripped with 60 N, at rest.
const grasp::Grasp& grasp_of_60() {
  static const study::AssessmentSet set = session_with(handle(40.0)).take_hold(1, task_of(60.0));
  return set.assessments.front().assessment.grasp;
}

TEST(LiveSession, HoldAtRestIsWhatAssessFinds) {
  const product::Product product = handle(40.0);
  LiveSession session = session_with(product);
  AssessRequest request;
  request.products.emplace_back(product);
  request.hand.value = coarse_hand();
  request.model = contact::ContactModel{};
  request.grasp.is_place_per_hand = true;  // the hand of this test is not the built-in one
  for (const double force : {60.0, 35.0}) {
    request.rest.grip_force = force;
    AssessOutcome outcome = assess_products(request);
    study::AssessmentSet live = session.take_hold(1, task_of(force));
    // What was asked for to find the hold is said otherwise: by its number.
    live.assessments.front().assessment.options.grasp =
        outcome.set.assessments.front().assessment.options.grasp;
    EXPECT_EQ(comparable(live), comparable(outcome.set)) << force << " N";
  }
}

TEST(LiveSession, HoldsAreRankedOnceAndStartWithTheOneThatIsTaken) {
  LiveSession session = session_with(handle(40.0));
  const grasp::RankedHolds* first = &session.holds();
  EXPECT_EQ(&session.holds(), first);
  ASSERT_FALSE(first->holds.empty());
  const study::AssessmentSet set = session.take_hold(1, task_of(50.0));
  ASSERT_TRUE(set.assessments.front().assessment.grasp.hold.has_value());
  EXPECT_EQ(set.assessments.front().assessment.grasp.hold_words, first->holds.front().words);
}

TEST(LiveSession, HoldsThatAreNotThereAreRefused) {
  LiveSession session = session_with(handle(40.0));
  EXPECT_THROW(session.take_hold(0, task_of(50.0)), UsageError);
  EXPECT_THROW(session.take_hold(200, task_of(50.0)), UsageError);
}

TEST(LiveSession, ContactOfAMotionIsThatOfTheEvaluatedPlace) {
  LiveSession session = session_with(handle(40.0));
  const grasp::Grasp& grasp = grasp_of_60();
  LivePose pose{grasp.posture, grasp.product_from_hand};
  for (int step = 0; step < 4; ++step) {
    pose.product_from_hand.translation += Vec3(0.3, -0.2, 0.25);  // mm
    const contact::ContactResult& moving = session.move(pose);
    const study::AssessmentSet there = session.evaluate_here(pose, grasp.grip, {});
    const contact::ContactResult& still = there.assessments.front().assessment.contact;
    ASSERT_EQ(moving.pressure.size(), still.pressure.size());
    // Moduli are settled to 1 % on the way, to 0.001 % at rest. Skin that bulges until it touches,
    // with next to no force, is left out of the area.
    EXPECT_NEAR(moving.total.force, still.total.force, 0.02 * still.total.force);
    EXPECT_NEAR(moving.total.area, still.total.area, 0.15 * still.total.area);
    EXPECT_NEAR(moving.total.peak_pressure_cells, still.total.peak_pressure_cells,
                0.03 * still.total.peak_pressure_cells);
  }
}

TEST(LiveSession, HandAndProductMovedTogetherPressTheSame) {
  LiveSession session = session_with(handle(40.0));
  const grasp::Grasp& grasp = grasp_of_60();
  const double before = grasp::grip_force(session.move({grasp.posture, grasp.product_from_hand}),
                                          *session.product().distance)
                            .force;
  EXPECT_NEAR(before, 60.0, 1.2);  // N; settling ends within 2 % of it
  // A cylinder looks the same after half a turn about an axis across it.
  const geometry::Rigid3 turned =
      geometry::Rigid3::about_axis(Vec3::UnitX(), Vec3::Zero(), std::numbers::pi);
  const double after =
      grasp::grip_force(session.move({grasp.posture, turned * grasp.product_from_hand}),
                        *session.product().distance)
          .force;
  EXPECT_NEAR(after, before, 0.01 * before);
}

TEST(LiveSession, FingersCloseWhereTheProductWasPut) {
  LiveSession session = session_with(handle(40.0));
  const grasp::Grasp& grasp = grasp_of_60();
  LivePose open{hand::reference_posture(session.hand().skeleton), grasp.product_from_hand};
  const study::AssessmentSet closed = session.close_here(open, grasp.grip, task_of(60.0));
  const study::Assessment& held = closed.assessments.front().assessment;
  EXPECT_EQ(held.balance.status, grasp::BalanceStatus::kBalanced) << held.balance.message;
  EXPECT_NEAR(held.balance.grip_force, 60.0, 1.2);  // N
}

TEST(LiveSession, RestFollowsTheGripForceFromWhereItIs) {
  LiveSession session = session_with(handle(40.0));
  const grasp::Grasp& grasp = grasp_of_60();
  const study::AssessmentSet firm =
      session.rest_here({grasp.posture, grasp.product_from_hand}, grasp.grip, task_of(90.0));
  const grasp::Balance& balance = firm.assessments.front().assessment.balance;
  EXPECT_EQ(balance.status, grasp::BalanceStatus::kBalanced) << balance.message;
  EXPECT_NEAR(balance.grip_force, 90.0, 1.8);  // N
}

TEST(LiveSession, NumbersThatAreNotFiniteAreRefused) {
  LiveSession session = session_with(handle(40.0));
  LivePose pose;
  pose.product_from_hand.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(session.move(pose), UsageError);
  EXPECT_THROW(session.evaluate_here(pose, grasp::Grip::kMediumWrap, {}), UsageError);
}

TEST(LiveSession, CancelledHoldLeavesTheSessionUsable) {
  LiveSession session = session_with(handle(40.0));
  std::atomic<bool> cancel{true};
  Progress progress;
  progress.cancel = &cancel;
  EXPECT_THROW(session.take_hold(1, task_of(60.0), progress), Cancelled);
  cancel = false;
  const study::AssessmentSet set = session.take_hold(1, task_of(60.0), progress);
  EXPECT_EQ(set.assessments.front().assessment.balance.status, grasp::BalanceStatus::kBalanced);
}

}  // namespace
}  // namespace palmar::workflow
