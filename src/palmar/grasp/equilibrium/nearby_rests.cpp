// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/equilibrium/nearby_rests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/scaled_distance.h"

namespace palmar::grasp {
namespace {

constexpr double kOtherSize = 1.06;        // of products from which another rest is looked for
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

/// A rest that a product of other size leads to, unless it is the one that is known.
std::optional<EffortRest> rest_beside(const contact::PreparedHand& hand,
                                      const product::Product& product,
                                      const product::Product& other_size, const EffortRest& rest,
                                      const EffortTask& task,
                                      const contact::ContactOptions& contact,
                                      const Progress& progress) {
  std::optional<GripState> from;
  if (rest.on_coarse_skin) {
    const auto beside = rest_on_coarse_skin(hand, other_size, rest.start, task, contact, progress);
    if (!beside) return std::nullopt;
    from = rest_on_coarse_skin(hand, product, rest.start, task, contact, progress, &*beside);
    if (!from || !is_elsewhere(*from, *rest.on_coarse_skin, rest.held_at)) return std::nullopt;
  } else {
    const EffortRest beside =
        rest_with_least_effort(hand, other_size, rest.start, task, contact, progress);
    if (beside.status != EffortRest::Status::kSolved) return std::nullopt;
    from = beside.state;
  }
  const SearchStart start{.on_skin = *from};
  EffortRest found =
      rest_with_least_effort(hand, product, rest.start, task, contact, progress, &start);
  found.on_coarse_skin = from;
  const bool is_another = found.status == EffortRest::Status::kSolved &&
                          is_elsewhere(found.state, rest.state, rest.held_at);
  return is_another ? std::optional<EffortRest>(std::move(found)) : std::nullopt;
}

}  // namespace

std::optional<EffortRest> other_rest(const contact::PreparedHand& hand,
                                     const product::Product& product, const EffortRest& rest,
                                     const EffortTask& task, const contact::ContactOptions& contact,
                                     const Progress& progress) {
  const Vec3 centre = rest.start.product_from_hand * rest.held_at;
  Progress quiet = progress;
  quiet.report = nullptr;
  std::array<std::optional<EffortRest>, 2> found;
  parallel_for(found.size(), [&](std::size_t i) {
    const double factor = i == 0 ? kOtherSize : 1.0 / kOtherSize;
    found[i] =
        rest_beside(hand, product, scaled(product, centre, factor), rest, task, contact, quiet);
  });
  std::optional<EffortRest> least;
  for (std::optional<EffortRest>& one : found) {
    if (!one || !is_doubt(rest, *one)) continue;
    if (!least || one->merit.back() < least->merit.back()) least = std::move(one);
  }
  return least;
}

bool is_doubt(const EffortRest& rest, const EffortRest& other) {
  return other.merit.back() <= kNoDoubt * rest.merit.back();
}

NearbyRests nearby_rests(const contact::PreparedHand& hand, const product::Product& product,
                         const EffortRest& rest, const EffortTask& task,
                         const contact::ContactOptions& contact) {
  NearbyRests nearby;
  const Vec3 centre = rest.start.product_from_hand * rest.held_at;
  const double larger = 1.0 + kNearbyChange;
  const product::Product shrunk = scaled(product, centre, 1.0 / larger);
  nearby.shrunk = shrunk.distance;
  nearby.firmer = rest_after_change(hand, product, product, rest, larger, task, contact);
  nearby.in_larger_hand =
      rest_after_change(hand, product, shrunk, rest, 1.0 / (larger * larger), task, contact);
  return nearby;
}

}  // namespace palmar::grasp
