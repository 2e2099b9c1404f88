// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/muscle_balance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/hand/tendons/tendon_test_hand.h"

namespace palmar::hand {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Eigen::VectorXi;

MuscleProblem one_axis(std::initializer_list<double> moments, double required, int exponent) {
  MuscleProblem problem;
  problem.moment_at_strength = MatrixXd(1, static_cast<Eigen::Index>(moments.size()));
  Eigen::Index i = 0;
  for (const double m : moments) problem.moment_at_strength(0, i++) = m;
  problem.required = VectorXd::Constant(1, required);
  problem.stop = VectorXi::Zero(1);
  problem.exponent = exponent;
  return problem;
}

TEST(BalanceMuscles, SharesByMomentForExponentTwo) {
  // min a1^2 + a2^2 with 300 a1 + 400 a2 = 125: a = 125 (300, 400) / (300^2 + 400^2).
  const MuscleSolution solution = balance_muscles(one_axis({300, 400}, 125, 2));
  ASSERT_EQ(solution.status, MuscleStatus::kBalanced);
  EXPECT_NEAR(solution.activation[0], 0.15, 1e-8);
  EXPECT_NEAR(solution.activation[1], 0.20, 1e-8);
  EXPECT_LT(solution.kkt_residual, 1e-7);
}

TEST(BalanceMuscles, SharesByRootOfMomentForExponentThree) {
  // Stationarity 3 a_i^2 = y m_i: a = (1, 2) t for moments 100 and 400; 100 t + 800 t = 90.
  const MuscleSolution solution = balance_muscles(one_axis({100, 400}, 90, 3));
  ASSERT_EQ(solution.status, MuscleStatus::kBalanced);
  EXPECT_NEAR(solution.activation[0], 0.1, 1e-8);
  EXPECT_NEAR(solution.activation[1], 0.2, 1e-8);
}

TEST(BalanceMuscles, AntagonistRests) {
  const MuscleSolution solution = balance_muscles(one_axis({300, -200}, 150, 2));
  EXPECT_NEAR(solution.activation[0], 0.5, 1e-8);
  EXPECT_EQ(solution.activation[1], 0.0);
}

TEST(BalanceMuscles, FullMuscleLeavesTheRestToTheOther) {
  // By moments alone (1 : 3) the second would have to give 1.2 of its strength.
  const MuscleSolution solution = balance_muscles(one_axis({100, 300}, 380, 2));
  ASSERT_EQ(solution.status, MuscleStatus::kBalanced);
  EXPECT_NEAR(solution.activation[1], 1.0, 1e-7);
  EXPECT_NEAR(solution.activation[0], 0.8, 1e-6);
}

TEST(BalanceMuscles, OverloadReportsWhatIsMissing) {
  const MuscleSolution solution = balance_muscles(one_axis({100, -40}, 250, 3));
  ASSERT_EQ(solution.status, MuscleStatus::kOverloaded);
  EXPECT_NEAR(solution.missing[0], 150.0, 1e-4);
  EXPECT_NEAR(solution.activation[0], 1.0, 1e-6);
}

TEST(BalanceMuscles, AxisWithoutMusclesMissesEverything) {
  const MuscleSolution solution = balance_muscles(one_axis({0.0}, -3.0, 2));
  ASSERT_EQ(solution.status, MuscleStatus::kOverloaded);
  EXPECT_NEAR(solution.missing[0], -3.0, 1e-6);
}

TEST(BalanceMuscles, StopHoldsInItsDirectionOnly) {
  MuscleProblem problem = one_axis({100, -100}, -80, 2);
  problem.stop[0] = -1;
  const MuscleSolution held = balance_muscles(problem);
  EXPECT_EQ(held.status, MuscleStatus::kBalanced);
  EXPECT_NEAR(held.stop[0], -80.0, 1e-3);
  EXPECT_LT(held.activation.maxCoeff(), 1e-4);
  problem.stop[0] = 1;
  const MuscleSolution by_muscle = balance_muscles(problem);
  EXPECT_NEAR(by_muscle.activation[1], 0.8, 1e-6);
  EXPECT_NEAR(by_muscle.stop[0], 0.0, 1e-6);
}

TEST(BalanceMuscles, StopOfBothWaysHoldsEither) {
  for (const double required : {-80.0, 80.0}) {
    MuscleProblem problem = one_axis({100, -100}, required, 3);
    problem.stop[0] = 2;
    const MuscleSolution held = balance_muscles(problem);
    EXPECT_EQ(held.status, MuscleStatus::kBalanced);
    EXPECT_NEAR(held.stop[0], required, 0.1);  // N mm; resting muscles end at 1e-3 for n = 3
    EXPECT_LT(held.activation.maxCoeff(), 2e-3);
  }
}

TEST(BalanceMuscles, NoLoadNoForce) {
  const MuscleSolution solution = balance_muscles(one_axis({100, -100}, 0.0, 3));
  EXPECT_EQ(solution.status, MuscleStatus::kBalanced);
  EXPECT_EQ(solution.activation, VectorXd::Zero(2));
}

MuscleProblem random_problem(std::mt19937& random, int exponent, double largest) {
  const Hand hand = effort_test::plain_hand();
  const Finger finger = effort_test::kFingers[random() % 5];
  const Posture posture = effort_test::random_posture(hand.skeleton, finger, random);
  const auto arms =
      moment_arms(route_tendons(hand, finger), pose_digit(hand.skeleton, finger, posture));
  MuscleProblem problem;
  const auto count = static_cast<Eigen::Index>(arms.size());
  problem.moment_at_strength.resize(kDigitDofs, count);
  VectorXd activation(count);
  std::uniform_real_distribution<double> share(0.0, largest);
  for (Eigen::Index i = 0; i < count; ++i) {
    activation[i] = share(random);
    for (Eigen::Index k = 0; k < kDigitDofs; ++k) {
      problem.moment_at_strength(k, i) =
          arms[i][k] * kSpecificTension * cross_section_of(finger, tendons_of(finger)[i]);
    }
  }
  problem.required = problem.moment_at_strength * activation;
  problem.stop = VectorXi::Zero(kDigitDofs);
  problem.exponent = exponent;
  return problem;
}

double cost(const VectorXd& activation, int exponent) {
  return activation.array().pow(exponent).sum();
}

TEST(BalanceMuscles, NoFeasibleNeighbourCostsLess) {
  // Independent of multipliers: from the solution towards random feasible points (equilibrium kept
  // by the null space, bounds by shortening) the convex cost must not fall.
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  for (int sample = 0; sample < 60; ++sample) {
    const int exponent = 2 + sample % 2;
    const MuscleProblem problem = random_problem(random, exponent, 1.0);
    const MuscleSolution solution = balance_muscles(problem);
    ASSERT_EQ(solution.status, MuscleStatus::kBalanced);
    const VectorXd& a = solution.activation;
    EXPECT_LT((problem.moment_at_strength * a - problem.required).norm(),
              1e-6 * problem.required.norm());
    const MatrixXd free = problem.moment_at_strength.fullPivLu().kernel();
    for (int direction = 0; direction < 20; ++direction) {
      VectorXd step(free.cols());
      for (double& s : step) s = normal(random);
      VectorXd way = free * step;
      double length = 0.1 / way.lpNorm<Eigen::Infinity>();
      for (Eigen::Index i = 0; i < a.size(); ++i) {
        if (way[i] > 0.0) length = std::min(length, (1.0 - a[i]) / way[i]);
        if (way[i] < 0.0) length = std::min(length, a[i] / -way[i]);
      }
      EXPECT_GE(cost(a + length * way, exponent), cost(a, exponent) - 1e-7);
    }
  }
}

TEST(BalanceMuscles, LoadScalesActivations) {
  // sum a^n is homogeneous: twice the load, twice every activation, while none is full.
  std::mt19937 random(19);
  for (int sample = 0; sample < 20; ++sample) {
    MuscleProblem problem = random_problem(random, 2 + sample % 2, 0.1);
    const MuscleSolution once = balance_muscles(problem);
    problem.required *= 2.0;
    const MuscleSolution twice = balance_muscles(problem);
    ASSERT_LT(twice.activation.maxCoeff(), 1.0);
    EXPECT_LT((twice.activation - 2.0 * once.activation).lpNorm<Eigen::Infinity>(), 1e-6);
    problem.required *= 0.5e-6;  // a feather
    const MuscleSolution feather = balance_muscles(problem);
    EXPECT_LT((1e6 * feather.activation - once.activation).lpNorm<Eigen::Infinity>(), 1e-6);
  }
}

// The equations of a step overflow: what comes out is finite and called what it is.
TEST(BalanceMuscles, StaysFiniteWhereAStepDoesNot) {
  const MuscleSolution solution = balance_muscles(one_axis({1}, 1e60, 3));
  EXPECT_EQ(solution.status, MuscleStatus::kNotConverged);
  EXPECT_LT(solution.iterations, 100);
  EXPECT_EQ(solution.activation[0], 1.0);
  EXPECT_TRUE(std::isfinite(solution.missing[0]));
  EXPECT_TRUE(std::isfinite(solution.kkt_residual));
}

TEST(BalanceMuscles, BadInputIsNamed) {
  EXPECT_THAT([] { balance_muscles(one_axis({1}, 1, 4)); },
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("exponent is 4; 2 or 3")));
  MuscleProblem problem = one_axis({1}, 1, 2);
  problem.stop = VectorXi::Zero(3);
  EXPECT_THAT(
      [&] { balance_muscles(problem); },
      testing::ThrowsMessage<UsageError>(testing::HasSubstr("3 stops and 0 prices for 1 axes")));
  problem = one_axis({std::nan("")}, 1, 2);
  EXPECT_THAT([&] { balance_muscles(problem); },
              testing::ThrowsMessage<UsageError>(testing::HasSubstr("not finite")));
}

TEST(LeastStrengthShare, IsThatOfEqualActivation) {
  // 300 a + 100 a = 100: a quarter of both, whatever effort would prefer; a load of 1000 takes 2.5
  // times their strength.
  EXPECT_NEAR(least_strength_share(one_axis({300, 100}, 100, 3), 0.0), 0.25, 0.01);
  EXPECT_NEAR(least_strength_share(one_axis({300, 100}, 1000, 3), 0.0), 2.5, 0.03);
  EXPECT_NEAR(least_strength_share(one_axis({300, 100}, 1000, 3), 200.0), 2.0, 0.03);
}

TEST(LeastStrengthShare, IsInfiniteWhereNoStrengthCould) {
  EXPECT_TRUE(std::isinf(least_strength_share(one_axis({300, 100}, -50, 3), 1.0)));
}

TEST(BalanceMuscles, LeavesTheCheaperAxisShort) {
  // One muscle for two axes that ask for more and less than it gives: the dear axis is met.
  MuscleProblem problem = one_axis({1.0}, 0.0, 3);
  problem.moment_at_strength = MatrixXd::Constant(2, 1, 100.0);
  problem.required = (VectorXd(2) << 80.0, 20.0).finished();
  problem.stop = VectorXi::Zero(2);
  problem.price = (VectorXd(2) << 1.0, 0.01).finished();
  MuscleSolution solution = balance_muscles(problem);
  EXPECT_NEAR(solution.activation[0], 0.8, 1e-6);
  EXPECT_NEAR(solution.missing[1], -60.0, 1e-3);
  problem.price = (VectorXd(2) << 0.01, 1.0).finished();
  solution = balance_muscles(problem);
  EXPECT_NEAR(solution.activation[0], 0.2, 1e-6);
  EXPECT_NEAR(solution.missing[0], 60.0, 1e-3);
}

}  // namespace
}  // namespace palmar::hand
