// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/effort_program.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/core/random.h"

namespace palmar::grasp {
namespace {

constexpr double kDear = 1e3;  // a price above what any load here costs the muscles

/// Muscles with these moments about one axis.
EffortProgram one_axis(const Eigen::RowVectorXd& moments, double required, double price = kDear) {
  EffortProgram program;
  program.muscles = moments;
  program.motion.resize(1, 0);
  program.required = Eigen::VectorXd::Constant(1, required);
  program.price = Eigen::VectorXd::Constant(1, price);
  return program;
}

// Of 3 a_i^2 = y m_i follows a_i = b sqrt(m_i) / sum m_j^1.5.
TEST(EffortProgram, MusclesShareAMomentAsTheSquareRootsOfTheirArms) {
  const Eigen::RowVectorXd moments = Eigen::RowVector3d(1.0, 4.0, 9.0);
  const EffortSolution found = solve_effort(one_axis(moments, 7.2));
  ASSERT_TRUE(found.has_converged);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.activation[i], 7.2 * std::sqrt(moments[i]) / (1.0 + 8.0 + 27.0), 1e-6);
  }
  EXPECT_NEAR(found.missing[0], 0.0, 1e-9);
  EXPECT_NEAR(found.value, std::pow(7.2, 3) / std::pow(36.0, 2), 1e-6);
  EXPECT_NEAR(found.multiplier[0], 3.0 * 7.2 * 7.2 / (36.0 * 36.0), 1e-6);
}

TEST(EffortProgram, WhatMusclesAtFullActivationLackIsMissingAtItsPrice) {
  const EffortSolution found = solve_effort(one_axis(Eigen::RowVector2d(2.0, 3.0), 8.0));
  ASSERT_TRUE(found.has_converged);
  EXPECT_NEAR(found.activation.minCoeff(), 1.0, 1e-6);
  EXPECT_NEAR(found.missing[0], 3.0, 1e-5);
  EXPECT_NEAR(found.value, 2.0 + 3.0 * kDear, 1e-2);
  EXPECT_NEAR(found.multiplier[0], kDear, 1e-3);
}

TEST(EffortProgram, ALoadThatIsntWorthItsEffortIsLeft) {
  // 3 a^2 = price at a = 0.5: more isn't worth it.
  const EffortSolution found = solve_effort(one_axis(Eigen::RowVectorXd::Ones(1), 0.8, 0.75));
  ASSERT_TRUE(found.has_converged);
  EXPECT_NEAR(found.activation[0], 0.5, 1e-6);
  EXPECT_NEAR(found.missing[0], 0.3, 1e-6);
}

// A muscle and a spring share a load: a^3 + 1/2 h x^2 with a + x = b.
TEST(EffortProgram, MuscleAndMotionShareALoadAtEqualCost) {
  EffortProgram program = one_axis(Eigen::RowVectorXd::Ones(1), 0.9);
  program.motion = Eigen::MatrixXd::Ones(1, 1);
  program.hessian = Eigen::MatrixXd::Constant(1, 1, 2.0);
  program.gradient = Eigen::VectorXd::Zero(1);
  const EffortSolution found = solve_effort(program);
  ASSERT_TRUE(found.has_converged);
  // 3 a^2 = 2 (0.9 - a)
  const double a = (-1.0 + std::sqrt(1.0 + 3.0 * 1.8)) / 3.0;
  EXPECT_NEAR(found.activation[0], a, 1e-7);
  EXPECT_NEAR(found.motion[0], 0.9 - a, 1e-7);
}

/// Drawn problems like those of a hand: 28 rows, 37 muscles, 26 coordinates.
EffortProgram drawn(std::uint64_t seed) {
  RandomStream random(seed, 0);
  const auto matrix = [&](int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); });
  };
  constexpr int kRows = 28, kMuscles = 37, kCoordinates = 26;
  EffortProgram program;
  program.muscles = matrix(kRows, kMuscles);
  program.muscles.bottomRows(8).setZero();  // those of the product know no muscle
  program.motion = matrix(kRows, kCoordinates);
  program.required = 0.3 * matrix(kRows, 1);
  program.price = Eigen::VectorXd::Constant(kRows, 30.0);
  const Eigen::MatrixXd root = matrix(kCoordinates, kCoordinates);
  program.hessian = root * root.transpose() + Eigen::MatrixXd::Identity(kCoordinates, kCoordinates);
  program.gradient = matrix(kCoordinates, 1);
  return program;
}

TEST(EffortProgram, MultipliersAreTheChangeOfTheValue) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const EffortProgram program = drawn(seed);
    const EffortSolution found = solve_effort(program);
    ASSERT_TRUE(found.has_converged) << seed;
    for (const int row : {0, 13, 27}) {
      constexpr double kStep = 1e-4;
      EffortProgram more = program, less = program;
      more.required[row] += kStep;
      less.required[row] -= kStep;
      const double rate = (solve_effort(more).value - solve_effort(less).value) / (2.0 * kStep);
      EXPECT_NEAR(found.multiplier[row], rate, 1e-4 * (1.0 + std::abs(rate))) << seed << " " << row;
    }
  }
}

TEST(EffortProgram, NoOtherMotionOrActivationsCostLess) {
  const EffortProgram program = drawn(7);
  const EffortSolution best = solve_effort(program);
  ASSERT_TRUE(best.has_converged);
  RandomStream random(8, 0);
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd a = best.activation, x = best.motion;
    for (double& one : a) one = std::clamp(one + 0.05 * random.normal(), 0.0, 1.0);
    for (double& one : x) one += 0.05 * random.normal();
    const Eigen::VectorXd missing = program.required - program.muscles * a - program.motion * x;
    const double value = a.array().cube().sum() + program.gradient.dot(x) +
                         0.5 * x.dot(program.hessian * x) + program.price.dot(missing.cwiseAbs());
    EXPECT_GE(value, best.value - 1e-6);
  }
}

}  // namespace
}  // namespace palmar::grasp
