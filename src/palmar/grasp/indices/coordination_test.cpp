// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/coordination.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/indices/ease.h"

namespace palmar::grasp {
namespace {

/// Joints with ranges alone; that is all that ease asks of a skeleton.
hand::Skeleton plain_skeleton() {
  hand::Skeleton skeleton;
  for (int d = 0; d < hand::kDofCount; ++d) {
    hand::JointDof dof;
    dof.dof = static_cast<hand::Dof>(d);
    dof.lower = -10.0 * geometry::kDegree;
    dof.upper = 90.0 * geometry::kDegree;
    skeleton.joints[0].dofs.push_back(dof);
  }
  return skeleton;
}

int place(hand::Dof dof) { return static_cast<int>(dof) - (hand::kDofCount - kDigitDofCount); }

TEST(Coordination, WristDoesNotCount) {
  EXPECT_EQ(digit_dof(0), hand::Dof::kThumbCmcFlexion);
  EXPECT_EQ(digit_dof(kDigitDofCount - 1), hand::Dof::kLittleDipFlexion);
  const CoordinationBasis basis = built_in_coordination(plain_skeleton());
  hand::Posture posture, turned;
  turned[hand::Dof::kWristFlexion] = 1.0;
  EXPECT_EQ(distance_to(basis, posture).distance, distance_to(basis, turned).distance);
}

TEST(Coordination, BuiltInBasisHasWhatSantelloFound) {
  // Santello et al. 1998: two components carry more than 80 % of the variance, three about 90 %;
  // the first flexes all MCP and PIP joints together, the second MCP against PIP.
  const CoordinationBasis basis = built_in_coordination(plain_skeleton());
  const double two = basis.variance[0] + basis.variance[1];
  EXPECT_GT(two / basis.variance.sum(), 0.8);
  EXPECT_LT(two / basis.variance.sum(), 0.9);
  for (const hand::Dof dof :
       {hand::Dof::kIndexMcpFlexion, hand::Dof::kMiddleMcpFlexion, hand::Dof::kRingMcpFlexion,
        hand::Dof::kLittleMcpFlexion, hand::Dof::kIndexPipFlexion, hand::Dof::kMiddlePipFlexion,
        hand::Dof::kRingPipFlexion, hand::Dof::kLittlePipFlexion}) {
    EXPECT_GT(basis.component(place(dof), 0), 0.1) << name_of(dof);
  }
  const double mcp = basis.component(place(hand::Dof::kMiddleMcpFlexion), 1);
  const double pip = basis.component(place(hand::Dof::kMiddlePipFlexion), 1);
  EXPECT_LT(mcp * pip, 0.0);
  // DIP flexes with PIP (Rijkpema, Girard 1991).
  const int p = place(hand::Dof::kRingPipFlexion), d = place(hand::Dof::kRingDipFlexion);
  EXPECT_GT(basis.covariance(p, d) / std::sqrt(basis.covariance(p, p) * basis.covariance(d, d)),
            0.8);
  EXPECT_THAT(basis.source, testing::HasSubstr("construction, not a measurement"));
}

TEST(Coordination, ThumbAndIndexAreTheMostIndependent) {
  // Ingram et al. 2008: by the share of a digit's variance that the other digits don't predict.
  const CoordinationBasis basis = built_in_coordination(plain_skeleton());
  const auto own_share = [&](int first, int last) {
    std::vector<int> own, others;
    for (int k = 0; k < kDigitDofCount; ++k) (k >= first && k <= last ? own : others).push_back(k);
    Eigen::MatrixXd oo(others.size(), others.size()), io(own.size(), others.size());
    double all = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      all += basis.covariance(own[i], own[i]);
      for (std::size_t k = 0; k < others.size(); ++k) {
        io(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
            basis.covariance(own[i], others[k]);
      }
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
      for (std::size_t k = 0; k < others.size(); ++k) {
        oo(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
            basis.covariance(others[i], others[k]);
      }
    }
    return 1.0 - (io * oo.ldlt().solve(io.transpose())).trace() / all;
  };
  const double thumb = own_share(0, 3), index = own_share(4, 7), middle = own_share(8, 11),
               ring = own_share(12, 15), little = own_share(16, 19);
  EXPECT_GT(thumb, index);
  EXPECT_GT(index, middle);
  EXPECT_GT(index, ring);
  EXPECT_GT(index, little);
}

TEST(Coordination, CovarianceIsPositiveDefinite) {
  const CoordinationBasis basis = built_in_coordination(plain_skeleton());
  EXPECT_GT(basis.covariance.ldlt().vectorD().minCoeff(), 0.0);
  EXPECT_NEAR((basis.component.transpose() * basis.component - DigitMatrix::Identity()).norm(), 0.0,
              1e-12);
}

TEST(Coordination, MeasuredPosturesGiveTheirOwnDistribution) {
  // Postures drawn from a known law: two synergies and noise of half a degree.
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  DigitAngles a = DigitAngles::Zero(), b = DigitAngles::Zero();
  for (int k = 0; k < kDigitDofCount; ++k) (k % 2 == 0 ? a : b)[k] = 1.0 / std::sqrt(10.0);
  std::vector<hand::Posture> postures;
  for (int i = 0; i < 2000; ++i) {
    const double x = 60.0 * geometry::kDegree * normal(random),
                 y = 30.0 * geometry::kDegree * normal(random);
    hand::Posture posture;
    for (int k = 0; k < kDigitDofCount; ++k) {
      posture[digit_dof(k)] = 0.5 + x * a[k] + y * b[k] + 0.5 * geometry::kDegree * normal(random);
    }
    postures.push_back(posture);
  }
  const CoordinationBasis basis = coordination_basis(postures, "drawn");
  EXPECT_EQ(basis.postures, 2000);
  EXPECT_EQ(basis.retained, 2);
  EXPECT_NEAR(std::sqrt(basis.variance[0]) / geometry::kDegree, 60.0,
              3.0);  // 3 standard errors of 1.6 %
  EXPECT_NEAR(std::sqrt(basis.variance[1]) / geometry::kDegree, 30.0, 1.5);
  EXPECT_NEAR(std::abs(basis.component.col(0).dot(a)), 1.0, 1e-3);
  // Regularised: noise of half a degree is taken as one degree.
  EXPECT_NEAR(basis.variance[19], geometry::kDegree * geometry::kDegree, 1e-15);

  // Three deviations along the first synergy are three; the median is where half of them lie.
  hand::Posture far;
  for (int k = 0; k < kDigitDofCount; ++k) {
    far[digit_dof(k)] = basis.mean[k] + 3.0 * std::sqrt(basis.variance[0]) * basis.component(k, 0);
  }
  EXPECT_NEAR(distance_to(basis, far).distance, 3.0, 1e-9);
  EXPECT_NEAR(distance_to(basis, far).outside, 0.0, 1e-9);
  int within = 0;
  for (const hand::Posture& posture : postures) {
    const CoordinationDistance d = distance_to(basis, posture);
    within += d.distance < d.median ? 1 : 0;
  }
  EXPECT_NEAR(within / 2000.0, 0.5, 0.035);  // 3 standard errors
}

TEST(Coordination, TooFewPosturesAreRefused) {
  try {
    coordination_basis(std::vector<hand::Posture>(29), "mine.csv");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("mine.csv has 29 postures; at least 30"));
  }
}

TEST(Ease, MiddleOfTheRangeIsZeroAndItsEndIsOne) {
  const hand::Skeleton skeleton = plain_skeleton();
  const CoordinationBasis basis = built_in_coordination(skeleton);
  hand::Posture posture;
  for (double& angle : posture.angle) angle = 40.0 * geometry::kDegree;
  const EaseResult middle = assess_ease(skeleton, posture, basis);
  EXPECT_NEAR(middle.from_middle_rms, 0.0, 1e-12);
  EXPECT_EQ(middle.at_limit, 0);
  posture[hand::Dof::kRingPipFlexion] = 90.0 * geometry::kDegree;
  const EaseResult end = assess_ease(skeleton, posture, basis);
  EXPECT_NEAR(end.farthest_share, 1.0, 1e-12);
  EXPECT_EQ(end.farthest, hand::Dof::kRingPipFlexion);
  EXPECT_EQ(end.at_limit, 1);
  EXPECT_NEAR(end.from_middle_rms, std::sqrt(1.0 / 20.0), 1e-12);
}

TEST(Ease, RowsNameTheBasis) {
  const hand::Skeleton skeleton = plain_skeleton();
  const GraspIndices rows =
      to_indices(assess_ease(skeleton, hand::Posture{}, built_in_coordination(skeleton)));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0].key, "coordination_distance");
  EXPECT_THAT(rows[0].source, testing::HasSubstr("construction"));
  EXPECT_THAT(rows[0].remark, testing::HasSubstr("built-in basis"));
  for (const GraspIndex& row : rows) {
    EXPECT_EQ(row.group, "ease");
    EXPECT_EQ(row.better, Better::kDown);
    EXPECT_TRUE(row.value.has_value());
  }
}

}  // namespace
}  // namespace palmar::grasp
