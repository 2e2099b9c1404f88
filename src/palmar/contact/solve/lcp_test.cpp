// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/lcp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "palmar/contact/solve/lemke.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Random matrix with positive definite symmetric part: a P-matrix, not symmetric.
ContactProblem random_problem(int m, bool is_symmetric, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  MatrixXd a(m, m);
  MatrixXd b(m, m);
  VectorXd d(m);
  for (int i = 0; i < m; ++i) {
    d[i] = uniform(random);
    for (int j = 0; j < m; ++j) {
      a(i, j) = uniform(random);
      b(i, j) = uniform(random);
    }
  }
  MatrixXd R = a * a.transpose() + 0.1 * MatrixXd::Identity(m, m);
  if (!is_symmetric) R += b - b.transpose();
  return {R, d};
}

TEST(SolveContact, VertexLiftedByItsNeighbourCarriesNoForce) {
  // Vertex 0 overlaps by 1 mm and needs 0.5 N. That force moves vertex 1 by 0.5 mm, more than its
  // own 0.25 mm overlap, so vertex 1 separates.
  const ContactProblem problem{MatrixXd{{2.0, 1.0}, {1.0, 2.0}}, VectorXd{{-1.0, -0.25}}};
  for (const ContactSolution& solution : {solve_contact(problem), solve_contact_lemke(problem)}) {
    ASSERT_EQ(solution.status, LcpStatus::kSolved);
    EXPECT_NEAR(solution.force[0], 0.5, 1e-12);  // N; exact but for rounding
    EXPECT_EQ(solution.force[1], 0.0);
    EXPECT_NEAR(solution.gap[1], 0.25, 1e-12);  // mm
  }
}

TEST(SolveContact, EmptyAndSingleVertex) {
  EXPECT_EQ(solve_contact({}).status, LcpStatus::kSolved);
  EXPECT_EQ(solve_contact_lemke({}).status, LcpStatus::kSolved);
  const ContactProblem pressed{MatrixXd{{4.0}}, VectorXd{{-2.0}}};
  EXPECT_NEAR(solve_contact(pressed).force[0], 0.5, 1e-15);
  EXPECT_NEAR(solve_contact_lemke(pressed).force[0], 0.5, 1e-15);
  const ContactProblem apart{MatrixXd{{4.0}}, VectorXd{{2.0}}};
  EXPECT_EQ(solve_contact(apart).force[0], 0.0);
  EXPECT_EQ(solve_contact(apart).pivots, 0);
  EXPECT_EQ(solve_contact_lemke(apart).force[0], 0.0);
}

TEST(SolveContact, MurtysExponentialExample) {
  // Murty 1988, Linear Complementarity, section 6.1: R lower triangular with 1 on and 2 below the
  // diagonal, d_i = -(2^m + 2^(m-1) + ... + 2^(m-i+1)); answer p = (2^m, 0, ...). Lemke's method
  // needs about 2^m pivots.
  constexpr int m = 6;
  ContactProblem problem{MatrixXd::Identity(m, m), VectorXd(m)};
  double sum = 0.0;
  for (int i = 0; i < m; ++i) {
    sum += 1 << (m - i);
    problem.distance[i] = -sum;
    for (int j = 0; j < i; ++j) problem.response(i, j) = 2.0;
  }
  LcpOptions options;
  options.is_symmetric = false;
  LemkeOptions patient;
  patient.max_pivots = 1000;
  for (const ContactSolution& solution :
       {solve_contact(problem, options), solve_contact_lemke(problem, patient)}) {
    ASSERT_EQ(solution.status, LcpStatus::kSolved);
    EXPECT_NEAR(solution.force[0], 64.0, 1e-9);
    EXPECT_NEAR(solution.force.tail(m - 1).maxCoeff(), 0.0, 1e-12);
  }
}

TEST(SolveContact, FathisPositiveDefiniteExample) {
  // Fathi 1979: R = L L^T of Murty's L, d = -1; answer p = (1, 0, ..., 0).
  constexpr int m = 8;
  MatrixXd L = MatrixXd::Identity(m, m);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < i; ++j) L(i, j) = 2.0;
  }
  const ContactProblem problem{L * L.transpose(), VectorXd::Constant(m, -1.0)};
  const ContactSolution solution = solve_contact(problem);
  ASSERT_EQ(solution.status, LcpStatus::kSolved);
  EXPECT_NEAR(solution.force[0], 1.0, 1e-9);
  EXPECT_NEAR(solution.force.tail(m - 1).maxCoeff(), 0.0, 1e-12);
}

TEST(SolveContact, SingleExchangesEndTheCycleOfBlockExchanges) {
  // Principal minors 2, 1, 1; 2, 1, 10; 10: a P-matrix. Answer by hand: p = (0, 1/2, 1/2) gives
  // s = (3 - 3/2 + 1/2, 0, 0). Exchanging all infeasible vertices at once runs in a circle.
  const ContactProblem problem{MatrixXd{{2.0, -3.0, 1.0}, {0.0, 1.0, 3.0}, {1.0, -3.0, 1.0}},
                               VectorXd{{3.0, -2.0, 1.0}}};
  LcpOptions only_blocks;
  only_blocks.is_symmetric = false;
  only_blocks.max_fruitless_blocks = 1000000;
  only_blocks.max_pivots = 200;
  EXPECT_EQ(solve_contact(problem, only_blocks).status, LcpStatus::kPivotLimit);
  LcpOptions safeguarded;
  safeguarded.is_symmetric = false;
  const ContactSolution solution = solve_contact(problem, safeguarded);
  ASSERT_EQ(solution.status, LcpStatus::kSolved);
  EXPECT_NEAR(solution.force[0], 0.0, 1e-12);
  EXPECT_NEAR(solution.force[1], 0.5, 1e-12);
  EXPECT_NEAR(solution.force[2], 0.5, 1e-12);
  EXPECT_NEAR(solution.gap[0], 2.0, 1e-12);
}

TEST(SolveContact, UnsolvableProblemIsAStatus) {
  // s_0 + s_1 = -2 for every p: no solution. R is copositive-plus, so the ray proves it.
  const ContactProblem problem{MatrixXd{{1.0, -1.0}, {-1.0, 1.0}}, VectorXd{{-1.0, -1.0}}};
  const ContactSolution lemke = solve_contact_lemke(problem);
  EXPECT_EQ(lemke.status, LcpStatus::kRayTermination);
  EXPECT_EQ(lemke.force.maxCoeff(), 0.0);
  EXPECT_NE(solve_contact(problem).status, LcpStatus::kSolved);
}

TEST(SolveContact, DegenerateTouchCarriesNoForce) {
  // Vertex 1 is lifted exactly to the surface by vertex 0; vertex 2 rests on it from the start.
  const ContactProblem problem{MatrixXd{{2.0, 1.0, 0.5}, {1.0, 2.0, 0.5}, {0.5, 0.5, 2.0}},
                               VectorXd{{-2.0, -1.0, 0.0}}};
  for (const ContactSolution& solution : {solve_contact(problem), solve_contact_lemke(problem)}) {
    ASSERT_EQ(solution.status, LcpStatus::kSolved);
    EXPECT_NEAR(solution.force[0], 1.0, 1e-12);
    EXPECT_NEAR(solution.force[1], 0.0, 1e-12);
    EXPECT_NEAR(solution.force[2], 0.0, 1e-12);
  }
}

TEST(SolveContact, AgreesWithLemkeOnRandomProblems) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const int m = 1 + static_cast<int>(seed);
    for (const bool is_symmetric : {true, false}) {
      const ContactProblem problem = random_problem(m, is_symmetric, seed);
      LcpOptions options;
      options.is_symmetric = is_symmetric;
      const ContactSolution ours = solve_contact(problem, options);
      const ContactSolution lemke = solve_contact_lemke(problem);
      ASSERT_EQ(ours.status, LcpStatus::kSolved) << "seed " << seed;
      ASSERT_EQ(lemke.status, LcpStatus::kSolved) << "seed " << seed;
      EXPECT_LT(ours.relative_residual, 1e-9);
      EXPECT_LT((ours.force - lemke.force).cwiseAbs().maxCoeff(),
                1e-8 * (1.0 + lemke.force.maxCoeff()));
    }
  }
}

TEST(SolveContact, RefusesWhatIsNoProblem) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT(
      [] {
        solve_contact({MatrixXd(2, 3), VectorXd(2)});
      },
      ThrowsMessage<UsageError>(HasSubstr("2 x 3; a square one")));
  EXPECT_THAT(
      [] {
        solve_contact_lemke({MatrixXd::Identity(2, 2), VectorXd::Zero(3)});
      },
      ThrowsMessage<UsageError>(HasSubstr("3 distances")));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(
      [&] {
        solve_contact({MatrixXd::Identity(1, 1), VectorXd{{nan}}});
      },
      ThrowsMessage<UsageError>(HasSubstr("vertex 0 is not finite")));
}

}  // namespace
}  // namespace palmar::contact
