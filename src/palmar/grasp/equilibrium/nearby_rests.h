// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/equilibrium/least_effort.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// How much the force and the hand change in NearbyRests.
inline constexpr double kNearbyChange = 0.01;

/// What lies beside a rest: what it becomes if force and hand change a little, and whether the hand
/// may as well rest otherwise.
struct NearbyRests {
  GripState firmer;  ///< at kNearbyChange more force
  /// In a hand that is larger by kNearbyChange, measured by that hand: its own size, and a product
  /// that has shrunk. The same pressures press on areas that are larger in truth, by the square.
  GripState in_larger_hand;
  std::shared_ptr<const geometry::DistanceField> shrunk;
  /// Another state at rest (other_rest()).
  struct Other {
    GripState state;
    double merit = 1.0;  ///< over that of the first
  };
  std::optional<Other> other;
};

/// Another state at rest whose merit is at most 5 % above that of one, or below it, and in which an
/// angle or the product is elsewhere by more than 3 degrees or 1 mm; the lower where there are two.
/// Looked for by searches that begin where products 6 % larger and smaller come to rest; of a whole
/// hand on the coarse skin, and on the whole one only where that ends elsewhere. Deterministic.
/// Throws Cancelled.
std::optional<EffortRest> other_rest(const contact::PreparedHand& hand,
                                     const product::Product& product, const EffortRest& rest,
                                     const EffortTask& task, const contact::ContactOptions& contact,
                                     const Progress& progress = {});

/// Whether a hand may as well rest in another state: its merit is at most 5 % above that of `rest`.
bool is_doubt(const EffortRest& rest, const EffortRest& other);

/// What a small change makes of a rest, by its derivatives: the motion that the problem with linear
/// forces asks for after the change less that before. `other` stays unset. Deterministic.
NearbyRests nearby_rests(const contact::PreparedHand& hand, const product::Product& product,
                         const EffortRest& rest, const EffortTask& task,
                         const contact::ContactOptions& contact);

}  // namespace palmar::grasp
