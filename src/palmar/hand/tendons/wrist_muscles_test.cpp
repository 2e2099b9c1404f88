// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/wrist_muscles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/hand/tendons/hand_muscles.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using effort_test::plain_hand;
using effort_test::posture_of;

WristPosture at(double flexion, double deviation = 0.0) {
  return {flexion * geometry::kDegree, deviation * geometry::kDegree};
}

/// Largest moment about a wrist axis of all muscles that pull in that sense, wrist's and digits'.
double strongest(const Hand& hand, const WristPosture& wrist, int axis, double sense) {
  const HandMuscles muscles(hand, {.wrist = wrist});
  double sum = 0.0;
  for (std::size_t i = 0; i < muscles.wrist().arm.size(); ++i) {
    sum += std::max(0.0, sense * muscles.wrist().arm[i][axis] * muscles.wrist().strength[i]);
  }
  for (const Finger finger : {Finger::kIndex, Finger::kMiddle, Finger::kRing, Finger::kLittle}) {
    const DigitMuscles digit = muscles.in(finger, posture_of(finger, 45, 45, 25));
    for (std::size_t t = 0; t < digit.strength.size(); ++t) {
      sum += std::max(0.0, sense * digit.wrist_arm[t][axis] * digit.strength[t]);
    }
  }
  return sum;
}

TEST(WristMuscles, FlexorsFlexAndRadialOnesGoToTheThumb) {
  const WristMuscles muscles = wrist_muscles(plain_hand(), {}, kSpecificTension);
  const auto arm = [&](WristMuscle one) { return muscles.arm[index_of(one)]; };
  EXPECT_LT(arm(WristMuscle::kEcrl).x(), 0.0);
  EXPECT_GT(arm(WristMuscle::kEcrl).y(), 0.0);
  EXPECT_LT(arm(WristMuscle::kEcu).x(), 0.0);
  EXPECT_LT(arm(WristMuscle::kEcu).y(), 0.0);
  EXPECT_GT(arm(WristMuscle::kFcr).x(), 0.0);
  EXPECT_GT(arm(WristMuscle::kFcr).y(), 0.0);
  EXPECT_GT(arm(WristMuscle::kFcu).x(), 0.0);
  EXPECT_LT(arm(WristMuscle::kFcu).y(), 0.0);
}

// Ten men at the straight wrist and about it: flexion 12.2 N m (SD 3.7), extension 7.1 (SD 2.1;
// maximum isometric and passive wrist moments, abstract). Nothing in the model comes from there.
TEST(WristMuscles, PredictTheMeasuredMomentsOfTheWrist) {
  const Hand hand = plain_hand();
  EXPECT_NEAR(1e-3 * strongest(hand, at(0), 0, 1.0), 12.2, 2.0 * 3.7);
  EXPECT_NEAR(1e-3 * strongest(hand, at(0), 0, -1.0), 7.1, 2.1);
}

TEST(WristMuscles, ChangeLengthByTheirArm) {
  // A quarter of a radian of flexion lengthens an extensor with an arm of 12 mm by 3 mm.
  WristPosture wrist{};
  wrist.flexion += 0.25;
  EXPECT_NEAR(wrist_stretch({-12.0, 0.0}, wrist), 3.0, 1e-12);
  EXPECT_NEAR(wrist_stretch({12.0, 0.0}, wrist), -3.0, 1e-12);
  wrist = {};
  wrist.deviation -= 0.1;
  EXPECT_NEAR(wrist_stretch({0.0, 20.0}, wrist), 2.0, 1e-12);
}

TEST(WristMuscles, AFlexedWristWeakensTheFingersFlexors) {
  const Hand hand = plain_hand();
  const Posture fist = posture_of(Finger::kMiddle, 85, 90, 50);
  double last = 0.0;
  for (const double flexion : {60.0, 30.0, 0.0, -30.0, -60.0}) {
    const HandMuscles muscles(hand, {.wrist = at(flexion)});
    const double strength = muscles.in(Finger::kMiddle, fist).strength[0];
    EXPECT_GT(strength, last) << flexion;  // a fist shortens them already
    last = strength;
  }
}

TEST(WristMuscles, HandsOwnMusclesDoNothingThere) {
  const Hand hand = plain_hand();
  EXPECT_TRUE(wrist_arm(hand, Finger::kRing, Tendon::kLum).isZero(0.0));
  EXPECT_TRUE(wrist_arm(hand, Finger::kThumb, Tendon::kAdp).isZero(0.0));
}

TEST(WristMoment, IsForceTimesDistanceInTheSenseOfFlexion) {
  const Hand hand = plain_hand();
  // 10 N to the back of the hand 80 mm beyond the wrist bend it back; 10 N across don't.
  EXPECT_NEAR(wrist_moment(hand, {0, 0, -10}, {0, 80, 0}), -800.0, 1e-9);
  EXPECT_NEAR(wrist_moment(hand, {-10, 0, 0}, {0, 80, 0}), 0.0, 1e-9);
  EXPECT_NEAR(wrist_moment(hand, {0, 0, -10}, {0, 80, 0}, {500, 0, 0}), -300.0, 1e-9);
}

TEST(ProblemOf, AGripHasToBeHeldAtTheWristByItsExtensors) {
  const Hand hand = plain_hand();
  const HandMuscles muscles(hand);
  const std::vector<DigitMuscles> digits = {
      muscles.in(Finger::kMiddle, posture_of(Finger::kMiddle, 45, 45, 25))};
  HandLoad load;
  load.digit[index_of(Finger::kMiddle)] = {-1200.0, 0.0, -600.0, -150.0};
  const MuscleProblem problem = problem_of(digits, muscles.wrist(), load, 1.0);
  ASSERT_EQ(problem.required.size(), kDigitDofs + 1);
  const MuscleSolution solution = balance_muscles(problem);
  ASSERT_EQ(solution.status, MuscleStatus::kBalanced);
  // Equilibrium of the wrist, added up by hand.
  double flexion = 0.0, extensors = 0.0;
  for (std::size_t t = 0; t < digits[0].strength.size(); ++t) {
    flexion += solution.activation[static_cast<Eigen::Index>(t)] * digits[0].strength[t] *
               digits[0].wrist_arm[t].x();
  }
  for (std::size_t i = 0; i < muscles.wrist().arm.size(); ++i) {
    const double moment =
        solution.activation[static_cast<Eigen::Index>(digits[0].strength.size() + i)] *
        muscles.wrist().strength[i] * muscles.wrist().arm[i].x();
    flexion += moment;
    extensors += std::min(0.0, moment);
  }
  EXPECT_NEAR(flexion, 0.0, 1e-3);
  EXPECT_LT(extensors, -500.0);
  // A load that bends the wrist back relieves them.
  load.wrist = extensors;
  const MuscleSolution relieved = balance_muscles(problem_of(digits, muscles.wrist(), load, 1.0));
  EXPECT_LT(relieved.activation.tail(kWristMuscleCount).head(3).maxCoeff(),
            0.5 * solution.activation.tail(kWristMuscleCount).head(3).maxCoeff());
}

TEST(WristPosture, SaysWhatIsAllowed) {
  EXPECT_NO_THROW(at(-70, -35).check());
  try {
    at(80).check();
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("flexion is 80 degrees; -70 to 75 is allowed"));
  }
  EXPECT_THROW(at(0, 25).check(), UsageError);
  try {
    WristPosture{.flexion = std::nan("")}.check();
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("flexion is nan degrees"));
  }
}

}  // namespace
}  // namespace palmar::hand
