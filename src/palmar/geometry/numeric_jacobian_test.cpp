// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/numeric_jacobian.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palmar::geometry {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void residual(const VectorXd& x, VectorXd& r) {
  r = VectorXd{{std::sin(x[0]) * x[1], x[0] * x[0], 3.0 * x[1]}};
}

TEST(WithNumericJacobian, AgreesWithTheDerivativesInClosedForm) {
  const VectorXd x{{0.7, -2.0}};
  VectorXd r;
  MatrixXd jacobian;
  with_numeric_jacobian(residual)(x, r, &jacobian);
  const MatrixXd exact{{std::cos(0.7) * -2.0, std::sin(0.7)}, {1.4, 0.0}, {0.0, 3.0}};
  EXPECT_LT((jacobian - exact).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(r[1], 0.7 * 0.7);
}

TEST(WithNumericJacobian, StepsAreAskedForByVariableAndValue) {
  const VectorXd x{{5.0, 1.0}};
  VectorXd r;
  MatrixXd jacobian;
  // Of x^2 central differences are exact with any step.
  with_numeric_jacobian(residual, [](Eigen::Index j, double x_j) {
    EXPECT_EQ(x_j, j == 0 ? 5.0 : 1.0);
    return j == 0 ? 0.5 : 0.25;
  })(x, r, &jacobian);
  EXPECT_NEAR(jacobian(1, 0), 10.0, 1e-12);
  EXPECT_NEAR(jacobian(2, 1), 3.0, 1e-12);
}

TEST(WithNumericJacobian, OnlyResidualsWhereNoJacobianIsAskedFor) {
  int calls = 0;
  VectorXd r;
  with_numeric_jacobian([&](const VectorXd& x, VectorXd& out) {
    ++calls;
    out = x;
  })(VectorXd{{1.0, 2.0}}, r, nullptr);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace palmar::geometry
