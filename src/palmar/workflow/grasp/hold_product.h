// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp_settings.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"

namespace palmar {

/// A held product, and the ways to hold it that were ranked for that.
struct HeldProduct {
  Grasp grasp;
  std::shared_ptr<const RankedHolds> ways;  ///< null where a hold or coordinates were given
  std::shared_ptr<const Hand> ways_hand;    ///< that they were ranked with
};

/// How a hand takes hold of a product: by the part and in the way of the built-in hand (GraspPlace;
/// of its mirror image for a left hand), so that hands differ in size and not in how they hold. The
/// built-in hand searches, and so does every hand if `settings` ask for that or give the placement
/// in full, or if there is no built-in hand (share_folder()). `options`: options_for(settings,
/// product). Throws UsageError, Cancelled.
HeldProduct take_product(const std::shared_ptr<const Hand>& hand, const Product& product,
                         const GraspSettings& settings, const GraspOptions& options,
                         const Progress& progress = {});

/// The grasp alone.
Grasp hold_product(const std::shared_ptr<const Hand>& hand, const Product& product,
                   const GraspSettings& settings, const GraspOptions& options,
                   const Progress& progress = {});

}  // namespace palmar
