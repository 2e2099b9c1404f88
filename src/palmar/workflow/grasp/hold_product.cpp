// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/hold_product.h"

#include "palmar/core/error.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/hand/mirror.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar {
namespace {

/// Nothing where Palmar was installed without it: a program that brings hands of its own.
std::shared_ptr<const Hand> built_in_hand() {
  try {
    return load_hand("template");
  } catch (const InputError&) {
    return nullptr;
  }
}

void take_ways(const GraspPlace& place, const std::shared_ptr<const Hand>& hand,
               HeldProduct& held) {
  if (place.ranked().holds.empty()) return;
  held.ways = std::make_shared<const RankedHolds>(place.ranked());
  held.ways_hand = hand;
}

}  // namespace

std::shared_ptr<const Hand> reference_for(const std::shared_ptr<const Hand>& hand) {
  const std::shared_ptr<const Hand> built_in = built_in_hand();
  if (built_in == nullptr || hand->skin.vertices == built_in->skin.vertices) return hand;
  return hand->side == Side::kLeft ? std::make_shared<const Hand>(mirrored(*built_in)) : built_in;
}

HeldProduct take_product(const std::shared_ptr<const Hand>& hand, const Product& product,
                         const GraspSettings& settings, const GraspOptions& options,
                         const Progress& progress) {
  HeldProduct held;
  const bool is_alone = settings.is_place_per_hand || settings.placement.product_from_hand;
  const auto reference = is_alone ? hand : reference_for(hand);
  const GraspPlace place(*reference, product, options, progress);
  held.grasp =
      reference == hand ? place.reference_grasp() : place.hold(GraspingHand(hand), progress);
  take_ways(place, reference, held);
  return held;
}

Grasp hold_product(const std::shared_ptr<const Hand>& hand, const Product& product,
                   const GraspSettings& settings, const GraspOptions& options,
                   const Progress& progress) {
  return take_product(hand, product, settings, options, progress).grasp;
}

}  // namespace palmar
