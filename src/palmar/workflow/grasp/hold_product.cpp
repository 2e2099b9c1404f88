// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/hold_product.h"

#include "palmar/core/error.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/hand/mirror.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {
namespace {

/// Nothing where Palmar was installed without it: a program that brings hands of its own.
std::shared_ptr<const hand::Hand> built_in_hand() {
  try {
    return load_hand("template");
  } catch (const InputError&) {
    return nullptr;
  }
}

void take_ways(const grasp::GraspPlace& place, const std::shared_ptr<const hand::Hand>& hand,
               HeldProduct& held) {
  if (place.ranked().holds.empty()) return;
  held.ways = std::make_shared<const grasp::RankedHolds>(place.ranked());
  held.ways_hand = hand;
}

}  // namespace

std::shared_ptr<const hand::Hand> reference_for(const std::shared_ptr<const hand::Hand>& hand) {
  const std::shared_ptr<const hand::Hand> built_in = built_in_hand();
  if (built_in == nullptr || hand->skin.vertices == built_in->skin.vertices) return hand;
  return hand->side == hand::Side::kLeft
             ? std::make_shared<const hand::Hand>(hand::mirrored(*built_in))
             : built_in;
}

std::optional<Quat> HeldProduct::turn() const {
  const grasp::Grasp& taken = reference_grasp ? *reference_grasp : grasp;
  if (!taken.hold) return std::nullopt;
  return taken.product_from_hand.rotation;
}

HeldProduct take_product(const std::shared_ptr<const hand::Hand>& hand,
                         const product::Product& product, const grasp::GraspSettings& settings,
                         const grasp::GraspOptions& options, const Progress& progress) {
  HeldProduct held;
  const bool is_alone = settings.is_place_per_hand || settings.placement.product_from_hand;
  const auto reference = is_alone ? hand : reference_for(hand);
  const grasp::GraspPlace place(*reference, product, options, progress);
  held.grasp =
      reference == hand ? place.reference_grasp() : place.hold(grasp::GraspingHand(hand), progress);
  if (reference != hand) held.reference_grasp = place.reference_grasp();
  take_ways(place, reference, held);
  return held;
}

std::shared_ptr<const grasp::HoldAtRest> reference_at_rest(
    const std::optional<grasp::Grasp>& grasp, const std::shared_ptr<const hand::Hand>& hand,
    const product::Product& product, const study::AssessOptions& options,
    std::shared_ptr<const contact::PreparedHand>& reference, const Progress& progress) {
  if (!grasp || !options.balance.is_on || !grasp::is_by_whole_hand(grasp->grip)) return nullptr;
  if (reference == nullptr) {
    reference = std::make_shared<const contact::PreparedHand>(
        prepared_hand({}, reference_for(hand), contact::palmar_model()));
  }
  return grasp::hold_at_rest(*reference, product, *grasp, options.balance, options.contact,
                             progress);
}

grasp::Grasp hold_product(const std::shared_ptr<const hand::Hand>& hand,
                          const product::Product& product, const grasp::GraspSettings& settings,
                          const grasp::GraspOptions& options, const Progress& progress) {
  return take_product(hand, product, settings, options, progress).grasp;
}

}  // namespace palmar::workflow
