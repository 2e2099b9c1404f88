// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/hold_product.h"

#include <utility>

#include "palmar/core/error.h"
#include "palmar/grasp/rest/place_at_rest.h"
#include "palmar/hand/mirror.h"
#include "palmar/study/assessment/hold_doubts.h"
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

/// By a hand, at the place of another one, or of the same.
HeldProduct held_at(std::shared_ptr<const grasp::GraspPlace> place,
                    const std::shared_ptr<const hand::Hand>& reference,
                    const std::shared_ptr<const hand::Hand>& hand, const Progress& progress) {
  HeldProduct held;
  held.grasp = reference == hand ? place->reference_grasp()
                                 : place->hold(grasp::GraspingHand(hand), progress);
  if (reference != hand) held.reference_grasp = place->reference_grasp();
  if (!place->ranked().holds.empty()) {
    held.ways = std::make_shared<const grasp::RankedHolds>(place->ranked());
    held.ways_hand = reference;
  }
  held.place = std::move(place);
  return held;
}

/// The hand of reference_for(), made ready once.
const contact::PreparedHand& prepared_reference(
    const std::shared_ptr<const hand::Hand>& hand,
    std::shared_ptr<const contact::PreparedHand>& reference) {
  if (reference == nullptr) {
    reference = std::make_shared<const contact::PreparedHand>(
        prepared_hand({}, reference_for(hand), contact::palmar_model()));
  }
  return *reference;
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
  const bool is_alone = settings.is_place_per_hand || settings.placement.product_from_hand;
  const auto reference = is_alone ? hand : reference_for(hand);
  return held_at(std::make_shared<const grasp::GraspPlace>(*reference, product, options, progress),
                 reference, hand, progress);
}

std::optional<HeldProduct> held_otherwise(
    const HeldProduct& held, const study::Assessment& assessed,
    const std::shared_ptr<const hand::Hand>& hand, const contact::PreparedHand& prepared,
    const product::Product& product, const study::AssessOptions& options,
    std::shared_ptr<const contact::PreparedHand>& reference, const Progress& progress) {
  if (!options.grasp.leaves_hold_open() || held.ways == nullptr || !options.balance.is_on) {
    return std::nullopt;
  }
  const std::vector<study::HoldDoubt> doubts = study::doubts_of(assessed);
  if (assessed.grasp.status == grasp::GraspStatus::kHeld && doubts.empty()) return std::nullopt;
  std::string flaw = doubts.empty() ? assessed.grasp.message : doubts.front().words;
  Progress silent = progress;
  silent.report = nullptr;  // its share is not that of the whole
  grasp::BalanceOptions balance = options.balance;
  balance.like = nullptr;
  balance.looks_beside = balance.looks_beside || balance.looks_nearby;
  balance.looks_nearby = false;
  const contact::PreparedHand* ranks = &prepared;
  if (held.reference_grasp) {
    ranks = &prepared_reference(hand, reference);
    flaw = grasp::flaw_at_rest(*ranks, product, *held.reference_grasp, balance, options.contact,
                               silent);
    if (flaw.empty()) return std::nullopt;
  }
  auto other = grasp::other_place_at_rest(*ranks, product, *held.place, flaw, options.grasp,
                                          balance, options.contact, silent);
  if (!other) return std::nullopt;
  return held_at(std::make_shared<const grasp::GraspPlace>(std::move(*other)), held.ways_hand, hand,
                 silent);
}

std::shared_ptr<const grasp::HoldAtRest> reference_at_rest(
    const std::optional<grasp::Grasp>& grasp, const std::shared_ptr<const hand::Hand>& hand,
    const product::Product& product, const study::AssessOptions& options,
    std::shared_ptr<const contact::PreparedHand>& reference, const Progress& progress) {
  if (!grasp || !options.balance.is_on || !grasp::is_by_whole_hand(grasp->grip)) return nullptr;
  return grasp::hold_at_rest(prepared_reference(hand, reference), product, *grasp, options.balance,
                             options.contact, progress);
}

grasp::Grasp hold_product(const std::shared_ptr<const hand::Hand>& hand,
                          const product::Product& product, const grasp::GraspSettings& settings,
                          const grasp::GraspOptions& options, const Progress& progress) {
  return take_product(hand, product, settings, options, progress).grasp;
}

}  // namespace palmar::workflow
