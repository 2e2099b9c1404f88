// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/block_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palmar/contact/bone/loaded_skin.h"
#include "palmar/contact/solve/lcp.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/hand/tissue.h"

namespace palmar::contact {
namespace {

/// A ball of skin round a ball of bone, its halves two regions with different tissue; the skin near
/// the border of the two is pressed along z.
class PressedBall : public testing::Test {
 protected:
  void SetUp() override {
    ball.skin = geometry::make_icosphere(12.0, 3);
    ball.tissue = hand::default_tissue();
    for (Vec3& x : ball.skin.vertices) x.y() += 20.0;
    for (const Vec3& x : ball.skin.vertices) {
      ball.region.push_back(x.x() > 0.0 ? hand::Region::kIndexDistal : hand::Region::kThenar);
    }
    ball.segment.assign(ball.region.size(), hand::Segment::kIndexDistal);
    hand::Bone& bone = ball.bones.emplace_back();
    bone.mesh = geometry::make_icosphere(6.0, 3);
    for (Vec3& x : bone.mesh.vertices) x.y() += 20.0;
    for (hand::RegionTissue& tissue : ball.tissue.region) {
      for (hand::BoneTissueLaw* law :
           {&tissue.on_bone.low, &tissue.on_bone.nominal, &tissue.on_bone.high}) {
        law->stiffening = 8.0;
      }
    }
    ball_skin = skin_geometry(ball.skin);
    ball_compliance = skin_compliance(ball, ball_skin);
    ball_blocks = bone_tissue_blocks(ball, ball_skin, ball_compliance.volume);
    for (const int v : ball_compliance.vertex) {
      if (ball_skin.position[v].z() > 8.0) pressed.push_back(v);
    }
    LoadedSkin loaded(ball_skin, ball_compliance, nullptr, {});
    loaded.set(pressed, std::vector<Vec3>(pressed.size(), Vec3(0.0, 0.0, -1.0)));
    const SparseRows& rows = loaded.responses();
    responses = Eigen::MatrixXd::Zero(static_cast<int>(rows.size()), static_cast<int>(rows.size()));
    for (int i = 0; i < responses.rows(); ++i) {
      for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k) {
        responses(i, rows.column[k]) = static_cast<double>(rows.value[k]);
      }
    }
    ASSERT_GT(pressed.size(), 40U);
  }

  struct Solution {
    Eigen::VectorXd force, displacement;
    BlockStiffening lambda;
  };
  Eigen::VectorXd roots(const BlockStiffening& lambda) const {
    Eigen::VectorXd root(responses.rows());
    for (int i = 0; i < root.size(); ++i) {
      root[i] = root_modulus(ball_blocks, hand::TissueLevel::kNominal, lambda, pressed[i]);
    }
    return root;
  }
  BlockStiffening next(const BlockStiffening& lambda, const Eigen::VectorXd& force,
                       const Eigen::VectorXd& displacement) const {
    return stiffening_of(ball_blocks, hand::TissueLevel::kNominal, lambda, pressed,
                         {force.begin(), force.end()}, {displacement.begin(), displacement.end()});
  }
  /// Contact with gaps d before deformation.
  Solution solve(const Eigen::VectorXd& d) const {
    Solution result{{}, {}, no_stiffening()};
    for (int round = 0; round < 200; ++round) {
      const Eigen::VectorXd root = roots(result.lambda);
      ContactProblem problem;
      problem.response =
          root.cwiseInverse().asDiagonal() * responses * root.cwiseInverse().asDiagonal();
      problem.distance = d;
      const ContactSolution solution = solve_contact(problem);
      EXPECT_EQ(solution.status, LcpStatus::kSolved);
      result.force = solution.force;
      result.displacement = solution.gap - d;
      const BlockStiffening lambda = next(result.lambda, result.force, result.displacement);
      double change = 0.0;
      for (std::size_t b = 0; b < lambda.size(); ++b) {
        change = std::max(change, std::abs(lambda[b] / result.lambda[b] - 1.0));
      }
      if (change < 1e-13) break;
      result.lambda = lambda;
    }
    return result;
  }
  /// Stored energy, p . u - U*(p).
  double energy(const Solution& s) const {
    return 0.5 * s.force.dot(s.displacement) -
           stiffening_energy(ball_blocks, hand::TissueLevel::kNominal, s.lambda);
  }
  /// Gaps of a ball of 30 mm whose lowest point is at (x, 20 + y) and `depth` under the skin's top.
  Eigen::VectorXd gaps(double x, double y, double depth) const {
    Eigen::VectorXd d(responses.rows());
    for (int i = 0; i < d.size(); ++i) {
      const Vec3& at = ball_skin.position[pressed[i]];
      const double across = (at.head<2>() - Eigen::Vector2d(x, 20.0 + y)).squaredNorm();
      d[i] = 12.0 - depth + across / 60.0 - at.z();
    }
    return d;
  }

  hand::Hand ball;
  SkinGeometry ball_skin;
  SkinCompliance ball_compliance;
  BoneTissueBlocks ball_blocks;
  std::vector<int> pressed;
  Eigen::MatrixXd responses;
};

TEST_F(PressedBall, StiffensInBothBlocks) {
  const Solution s = solve(gaps(0.5, 0.0, 2.0));
  EXPECT_GT(s.lambda[static_cast<std::size_t>(hand::Region::kIndexDistal)], 1.2);
  EXPECT_GT(s.lambda[static_cast<std::size_t>(hand::Region::kThenar)], 1.2);
}

TEST_F(PressedBall, ForcesAreTheGradientOfTheEnergy) {
  const Eigen::VectorXd d = gaps(0.5, 0.3, 1.7);
  const Solution s = solve(d);
  constexpr double kStep = 1e-4;  // mm
  for (int i = 0; i < d.size(); i += 5) {
    Eigen::VectorXd up = d, down = d;
    up[i] += kStep;
    down[i] -= kStep;
    const double slope = (energy(solve(up)) - energy(solve(down))) / (2.0 * kStep);
    EXPECT_NEAR(-slope, s.force[i], 1e-6 + 2e-4 * s.force[i]) << i;
  }
}

TEST_F(PressedBall, WhatOneForceDoesToAnotherIsMutual) {
  // Small changes of two gaps: the Hessian of the energy is symmetric.
  const Eigen::VectorXd d = gaps(0.5, 0.3, 1.7);
  const Solution s = solve(d);
  std::vector<int> loaded;
  for (int i = 0; i < d.size(); ++i) {
    if (s.force[i] > 0.05 * s.force.maxCoeff()) loaded.push_back(i);
  }
  ASSERT_GT(loaded.size(), 8U);
  constexpr double kStep = 2e-5;  // mm
  const auto change = [&](int at) -> Eigen::VectorXd {
    Eigen::VectorXd up = d, down = d;
    up[at] += kStep;
    down[at] -= kStep;
    return (solve(up).force - solve(down).force) / (2.0 * kStep);
  };
  const Eigen::VectorXd first = change(loaded[0]);
  double scale = first.cwiseAbs().maxCoeff();
  for (std::size_t k = 1; k < loaded.size(); k += 3) {
    EXPECT_NEAR(change(loaded[k])[loaded[0]], first[loaded[k]], 1e-5 * scale);
  }
}

TEST_F(PressedBall, ThoroughNoWorkIsGainedOverAClosedPath) {
  // In, to the other block, deeper, and back: trapezia over a path of 400 steps.
  constexpr int kSteps = 400;
  double work = 0.0, in = 0.0;
  Eigen::VectorXd d_last;
  Eigen::VectorXd p_last;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = 2.0 * M_PI * k / kSteps;
    const Eigen::VectorXd d =
        gaps(2.0 * std::sin(angle), std::cos(2.0 * angle), 1.3 - 0.9 * std::cos(angle));
    const Eigen::VectorXd p = solve(d).force;
    if (k > 0) {
      const double step = -0.5 * (p + p_last).dot(d - d_last);
      work += step;
      in += std::max(step, 0.0);
    }
    d_last = d;
    p_last = p;
  }
  EXPECT_GT(in, 0.1);
  EXPECT_LT(std::abs(work), 1e-3 * in);
}

TEST(BlockEnergy, OneBlockStiffensWithTheRootOfItsEnergy) {
  BoneTissueBlocks blocks;
  blocks.begin = {0, 1};
  blocks.share = {{static_cast<int>(hand::Region::kThenar), 1.0}};
  const auto block = static_cast<std::size_t>(hand::Region::kThenar);
  for (auto& g0 : blocks.g0) g0 = {0.01};
  for (auto& k : blocks.per_energy) k[block] = 0.7;
  // Displacement u under the modulus G0 stores W = u^2 / 2 at a response of 100 mm/N.
  const double u = 1.1;
  const double energy = 0.5 * u * u / 100.0 * 100.0;
  const double lambda = 1.0 + std::sqrt(0.7 * energy);
  BlockStiffening start = no_stiffening();
  start[block] = lambda;
  const double force = lambda * u;  // at a response of 1 mm/N
  const BlockStiffening found =
      stiffening_of(blocks, hand::TissueLevel::kNominal, start, {0}, {force}, {u});
  EXPECT_NEAR(found[block], lambda, 1e-12);
  // U* is the dual of W + 2/3 sqrt(K) W^1.5.
  const double dual = force * u - energy - 2.0 / 3.0 * std::sqrt(0.7) * std::pow(energy, 1.5);
  EXPECT_NEAR(0.5 * force * u + stiffening_energy(blocks, hand::TissueLevel::kNominal, start), dual,
              1e-12);
}

}  // namespace
}  // namespace palmar::contact
