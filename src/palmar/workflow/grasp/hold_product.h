// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "palmar/core/progress.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/rest/hold_at_rest.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::workflow {

/// A held product, and the ways to hold it that were ranked for that.
struct HeldProduct {
  grasp::Grasp grasp;
  std::shared_ptr<const grasp::RankedHolds> ways;  ///< null where a hold or coordinates were given
  std::shared_ptr<const hand::Hand> ways_hand;     ///< that they were ranked with
  /// How that hand takes hold of it, where it is another one than the hand that holds.
  std::optional<grasp::Grasp> reference_grasp;
  /// Where; refers to the product.
  std::shared_ptr<const grasp::GraspPlace> place;

  /// For HoldOptions::like of other products; nothing if it isn't held.
  std::optional<Quat> turn() const;
};

/// The hand that holds are ranked and places are searched with, so that hands differ in size and
/// not in how they hold: the built-in hand, for a left hand its mirror image; `hand` itself if it
/// is the built-in one or there is none (share_folder()).
std::shared_ptr<const hand::Hand> reference_for(const std::shared_ptr<const hand::Hand>& hand);

/// How a hand takes hold of a product: by the part and in the way of the built-in hand (GraspPlace;
/// reference_for()). The built-in hand searches, and so does every hand if `settings` ask for that
/// or give the placement in full. `options`: options_for(settings, product). Throws UsageError,
/// Cancelled.
HeldProduct take_product(const std::shared_ptr<const hand::Hand>& hand,
                         const product::Product& product, const grasp::GraspSettings& settings,
                         const grasp::GraspOptions& options, const Progress& progress = {});

/// HeldProduct::reference_grasp at rest, for BalanceOptions::like of `hand`; null without one.
/// `reference` keeps the other hand prepared from call to call.
std::shared_ptr<const grasp::HoldAtRest> reference_at_rest(
    const std::optional<grasp::Grasp>& grasp, const std::shared_ptr<const hand::Hand>& hand,
    const product::Product& product, const study::AssessOptions& options,
    std::shared_ptr<const contact::PreparedHand>& reference, const Progress& progress = {});

/// The next best way to hold the product that comes to rest, if `held` doesn't and nothing says
/// which hold it is to be (grasp::other_place_at_rest()); nothing if there is none, or if it is
/// this hand alone that can't. `assessed` is what came of `held`, `prepared` its hand. Throws
/// Cancelled.
std::optional<HeldProduct> held_otherwise(
    const HeldProduct& held, const study::Assessment& assessed,
    const std::shared_ptr<const hand::Hand>& hand, const contact::PreparedHand& prepared,
    const product::Product& product, const study::AssessOptions& options,
    std::shared_ptr<const contact::PreparedHand>& reference, const Progress& progress = {});

/// The grasp alone.
grasp::Grasp hold_product(const std::shared_ptr<const hand::Hand>& hand,
                          const product::Product& product, const grasp::GraspSettings& settings,
                          const grasp::GraspOptions& options, const Progress& progress = {});

}  // namespace palmar::workflow
