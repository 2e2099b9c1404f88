// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/nearby_rests.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/scaled_distance.h"

namespace palmar::grasp {
namespace {

constexpr double kOtherSize = 1.02;        // of products from which another rest is looked for
constexpr double kNoDoubt = 1.05;          // of the merit; more is no doubt
constexpr double kElsewhereAngle = 0.052;  // rad
constexpr double kElsewhere = 1.0;         // mm

/// The product scaled about a point of it, for contact alone.
product::Product scaled(const product::Product& product, const Vec3& centre, double factor) {
  product::Product result = product;
  result.distance =
      std::make_shared<const geometry::ScaledDistance>(product.distance, centre, factor);
  return result;
}

bool is_elsewhere(const GripState& a, const GripState& b, const Vec3& held_at) {
  double angle = 0.0;
  for (int j = 0; j < kGripJoints; ++j) {
    angle = std::max(angle, std::abs(a.posture[grip_dof(j)] - b.posture[grip_dof(j)]));
  }
  const Vec3 apart = a.product_from_hand * held_at - b.product_from_hand * held_at;
  return angle > kElsewhereAngle || apart.norm() > kElsewhere;
}

}  // namespace

NearbyRests nearby_rests(const contact::PreparedHand& hand, const product::Product& product,
                         const EffortRest& rest, const EffortTask& task,
                         const contact::ContactOptions& contact, const Progress& progress) {
  NearbyRests nearby;
  const Vec3 centre = rest.start.product_from_hand * rest.held_at;
  const double larger = 1.0 + kNearbyChange;
  const product::Product shrunk = scaled(product, centre, 1.0 / larger);
  nearby.shrunk = shrunk.distance;
  nearby.firmer = rest_after_change(hand, product, product, rest, larger, task, contact);
  nearby.in_larger_hand =
      rest_after_change(hand, product, shrunk, rest, 1.0 / (larger * larger), task, contact);
  Progress quiet = progress;
  quiet.report = nullptr;
  std::array<EffortRest, 2> found;
  parallel_for(found.size(), [&](std::size_t i) {
    const double factor = i == 0 ? kOtherSize : 1.0 / kOtherSize;
    const EffortRest beside = rest_with_least_effort(hand, scaled(product, centre, factor),
                                                     rest.start, task, contact, quiet);
    if (beside.status != EffortRest::Status::kSolved) return;
    found[i] =
        rest_with_least_effort(hand, product, rest.start, task, contact, quiet, &beside.state);
  });
  for (const EffortRest& back : found) {
    if (back.status != EffortRest::Status::kSolved) continue;
    const double merit = back.merit.back() / rest.merit.back();
    if (merit > kNoDoubt || (nearby.other && merit >= nearby.other->merit)) continue;
    if (!is_elsewhere(back.state, rest.state, rest.held_at)) continue;
    nearby.other = NearbyRests::Other{.state = back.state, .merit = merit};
  }
  return nearby;
}

}  // namespace palmar::grasp
