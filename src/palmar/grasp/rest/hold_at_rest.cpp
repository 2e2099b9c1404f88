// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/hold_at_rest.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "palmar/hand/skin/skinning.h"

namespace palmar::grasp {
namespace {

constexpr double kLyingOn = 2.0;  // mm; skin of the palm that is so much farther off counts 1/e

/// Where the palm lies on a product: the mean of its skin, by how near each point is.
Vec3 palm_on(const hand::Hand& hand, const product::Product& product, const GripState& state) {
  const std::vector<Vec3> skin = hand::pose_skin(hand, state.posture);
  std::vector<std::pair<double, Vec3>> palm;  // distance
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand.segment[v] != hand::Segment::kPalm || hand.region[v] == hand::Region::kDorsum)
      continue;
    palm.emplace_back(product.distance->at(state.product_from_hand * skin[v]).distance, skin[v]);
    least = std::min(least, palm.back().first);
  }
  Vec3 sum = Vec3::Zero();
  double weights = 0.0;
  for (const auto& [distance, point] : palm) {
    const double weight = std::exp((least - distance) / kLyingOn);
    sum += weight * point;
    weights += weight;
  }
  return weights > 0.0 ? Vec3(sum / weights) : Vec3::Zero();
}

}  // namespace

bool is_by_whole_hand(Grip grip) { return is_power(grip) && grip != Grip::kFixedHook; }

GripState HoldAtRest::scaled(const GripState& state, double length) const {
  GripState result = state;
  result.product_from_hand.translation +=
      (1.0 - length / hand_length) * (state.product_from_hand.rotation * palm);
  return result;
}

std::shared_ptr<const HoldAtRest> hold_at_rest(const contact::PreparedHand& hand,
                                               const product::Product& product, const Grasp& grasp,
                                               const BalanceOptions& options,
                                               const contact::ContactOptions& contact,
                                               const Progress& progress) {
  if (!options.is_on || !is_by_whole_hand(grasp.grip) || grasp.status != GraspStatus::kHeld)
    return nullptr;
  HoldAtRest hold;
  hold.closed = {grasp.posture, grasp.product_from_hand};
  hold.palm = palm_on(hand.hand(), product, hold.closed);
  hold.hand_length = hand.hand().dimensions.hand_length;
  BalanceOptions own = options;
  own.like = nullptr;
  own.looks_nearby = false;
  own.looks_beside = true;
  Grasp at_rest = grasp;
  const Balance balance = balance_grasp(hand, product, at_rest, own, contact, progress);
  if (balance.status != BalanceStatus::kBalanced) return nullptr;
  hold.rest = {at_rest.posture, at_rest.product_from_hand};
  hold.on_coarse_skin = balance.on_coarse_skin.value_or(hold.rest);
  return std::make_shared<const HoldAtRest>(hold);
}

}  // namespace palmar::grasp
