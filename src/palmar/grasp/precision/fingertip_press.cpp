// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/fingertip_press.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/solve/skin_product.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::grasp {
namespace {

constexpr double kPulpReach = 11.0;  // mm round a fingertip point that can touch
constexpr double kRange = 10.0;      // mm; farther skin needn't know how far
constexpr int kRounds = 8;
constexpr double kDepthTolerance = 0.05;  // mm
constexpr double kMissed = 0.3;           // mm; a goal missed by more isn't pressed on
constexpr int kIterations = 30;
constexpr double kFarSide = 0.5;  // cosine of skin's and product's normal; such skin came through

std::vector<int> all_vertices(const hand::Hand& hand) {
  std::vector<int> vertices(hand.skin.vertices.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  return vertices;
}

}  // namespace

FingertipPress::FingertipPress(const FingertipIk& ik)
    : ik_(&ik), skin_(ik.hand(), all_vertices(ik.hand())) {
  geometry::area_weighted_normals(ik.hand().skin.vertices, ik.hand().skin.triangles, normal_);
}

SkinDepth FingertipPress::look(const geometry::DistanceField& product, const hand::Posture& posture,
                               const geometry::Rigid3& product_from_hand) const {
  std::vector<Vec3> posed;
  skin_.pose(posture, posed);
  for (Vec3& p : posed) p = product_from_hand * p;
  std::vector<geometry::DistanceSample> samples(posed.size());
  product.sample(posed, kRange, samples);
  const hand::Hand& hand = ik_->hand();
  SkinDepth result;
  result.palmar.fill(-kRange);
  result.any.fill(-kRange);
  for (std::size_t v = 0; v < posed.size(); ++v) {
    const std::size_t s = index_of(hand.segment[v]);
    result.any[s] = std::max(result.any[s], -samples[v].distance);
    if (hand.region[v] == hand::Region::kDorsum) continue;
    result.palmar[s] = std::max(result.palmar[s], -samples[v].distance);
  }
  return result;
}

std::vector<double> FingertipPress::depth_at(const geometry::DistanceField& product,
                                             const FingertipSolution& solution,
                                             const std::vector<FingertipGoal>& goals) const {
  const hand::Hand& hand = ik_->hand();
  const double flesh = contact::flesh_depth(hand);
  const hand::PosedSkeleton motion = hand::pose_skeleton(hand.skeleton, solution.posture);
  std::vector<double> result;
  for (const FingertipGoal& goal : goals) {
    std::vector<int> pulp;
    for (int v = 0; v < hand.skin.vertex_count(); ++v) {
      if (hand.segment[v] != goal.fingertip.segment) continue;
      if ((hand.skin.vertices[v] - goal.fingertip.point).norm() < kPulpReach) pulp.push_back(v);
    }
    const Quat turn = solution.product_from_hand.rotation *
                      motion.segment[index_of(goal.fingertip.segment)].rotation;
    std::vector<Vec3> normal;
    for (const int v : pulp) normal.push_back(turn * normal_[v]);
    std::vector<Vec3> posed;
    PosableSkin(hand, std::move(pulp)).pose(solution.posture, posed);
    for (Vec3& p : posed) p = solution.product_from_hand * p;
    std::vector<geometry::DistanceSample> samples(posed.size());
    product.sample(posed, kRange, samples);
    double deepest = -kRange;
    for (std::size_t k = 0; k < posed.size(); ++k) {
      double depth = -samples[k].distance;
      // Skin may be through a thin product.
      if (-depth < flesh && normal[k].dot(samples[k].normal) > kFarSide) {
        const auto passed =
            contact::surface_passed(product, posed[k], samples[k], normal[k], flesh);
        if (passed) depth = -passed->distance;
      }
      deepest = std::max(deepest, depth);
    }
    result.push_back(deepest);
  }
  return result;
}

FingertipSolution FingertipPress::press(FingertipProblem& problem, double depth) const {
  problem.max_iterations = kIterations;
  problem.is_refining = true;
  for (FingertipGoal& goal : problem.goals) {
    if (!goal.is_rest) goal.depth = depth;
  }
  FingertipSolution best;
  for (int round = 0; round < kRounds; ++round) {
    best = ik_->solve(problem);
    problem.start = best.posture;
    problem.product_from_hand = best.product_from_hand;
    const std::vector<double> reached = depth_at(*problem.product, best, problem.goals);
    double worst = 0.0;
    for (std::size_t k = 0; k < problem.goals.size(); ++k) {
      if (problem.goals[k].is_rest) continue;
      const double lack = depth - reached[k];
      if (best.miss[k] > kMissed && lack > 0.0) continue;
      worst = std::max(worst, std::abs(lack));
      problem.goals[k].depth = std::clamp(problem.goals[k].depth + lack, -8.0, 2.0 * depth + 4.0);
    }
    if (worst < kDepthTolerance) break;
  }
  return best;
}

}  // namespace palmar::grasp
