// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort_capacity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar::workflow {
namespace {

using testing::HasSubstr;
using workflow_test::coarse_hand;
using workflow_test::handle;

CapacityRequest capacity_request(const product::Product& product) {
  CapacityRequest request;
  request.product = product;
  request.hand.value = coarse_hand();
  return request;
}

TEST(CapacityOfGrip, FrictionCarriesNoMoreThanItsShareOfTheNormalForces) {
  constexpr double kRadius = 22.0;  // mm
  const Capacity capacity = capacity_of_grip(capacity_request(handle(2.0 * kRadius)));
  ASSERT_GT(capacity.grip_force, 50.0) << capacity.message;
  EXPECT_LE(capacity.activation, 1.0);
  // All normal forces are at most pi times the grip force round a bar (a uniform pressure has
  // pi / 2 on either side); friction pulls with mu times each of them at the radius.
  const double most = 0.5 * 3.15 * 1.2 * capacity.grip_force;
  EXPECT_LT(capacity.push, most);
  EXPECT_LT(capacity.pull, most);
  EXPECT_GT(capacity.pull, 0.1 * most);
  EXPECT_LT(capacity.torque, kRadius * most);
  EXPECT_GT(capacity.torque, 0.1 * kRadius * most);
}

TEST(CapacityOfGrip, ThoroughWeakerPeopleReachLessForceAndSlipperyProductsLessTorque) {
  CapacityRequest request = capacity_request(handle(44.0));
  request.strength = 400.0;
  const Capacity strong = capacity_of_grip(request);
  request.strength = 100.0;
  const Capacity weak = capacity_of_grip(request);
  EXPECT_LT(weak.grip_force, 0.8 * strong.grip_force);
  EXPECT_LT(weak.torque, strong.torque);
  request.friction.friction = 0.25;
  const Capacity slippery = capacity_of_grip(request);
  EXPECT_LT(slippery.torque, weak.torque);
}

TEST(CapacityOfGrip, TorqueIsAboutTheAxisAskedFor) {
  // Turning a bar end over end takes friction at the ends of the hand's breadth, not at the bar's
  // radius: another torque, of the same grip force.
  CapacityRequest request = capacity_request(handle(30.0));
  const Capacity about_bar = capacity_of_grip(request);
  request.torque_axis = about_bar.axis.unitOrthogonal();
  const Capacity across = capacity_of_grip(request);
  EXPECT_NEAR(across.grip_force, about_bar.grip_force, 1e-9);
  EXPECT_NEAR(across.torque_axis.dot(about_bar.axis), 0.0, 1e-12);
  EXPECT_GT(across.torque, 1.2 * about_bar.torque);
  request.torque_axis = Vec3::Zero();
  EXPECT_THROW(capacity_of_grip(request), UsageError);
}

TEST(CapacityOfGrip, SaysWhatItCannotTake) {
  CapacityRequest request = capacity_request(handle(44.0));
  request.strength = 5.0;
  try {
    capacity_of_grip(request);
    FAIL() << "5 N is nobody's grip strength";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("setting \"strength\" is 5 N; 10 to 2000 N is allowed"));
  }
  request = capacity_request(handle(44.0));
  request.grasp.grip = grasp::Grip::kFixedHook;
  try {
    capacity_of_grip(request);
    FAIL() << "hooked fingers have no capacity of a grip";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("computed for power grips"));
  }
}

}  // namespace
}  // namespace palmar::workflow
