// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/holds/hold.h"

namespace palmar::grasp {

/// What the choice of a hold asks of a product, once for all its holds.
struct HoldScene {
  const hand::Hand* hand = nullptr;
  const product::Product* product = nullptr;
  const product::ProductParts* parts = nullptr;
  Vec3 gravity_centre = Vec3::Zero();  ///< of the product's volume, product frame, mm
  double weight = 0.0;                 ///< N
  /// The product's up: as asked for, else of a body from its heavier to its lighter end.
  std::optional<Vec3> up;
  bool is_up_given = false;
  bool is_vessel = false;       ///< it has a hollow, whose mouth is up
  std::optional<Standing> lay;  ///< how it lies or stands where it is taken, if up is given
  /// By part: how much of the product's weight is in it, by how near `gravity_centre` is:
  /// together 1, but each of twin handles has what is in both.
  std::vector<double> weight_share;
  /// By part, 0 to 1: how much it is what the product has for the hand, a handle or a loop on
  /// something larger.
  std::vector<double> handle;

  /// Whether the part with that number, from 1, is more a handle than not.
  bool is_handle(int number) const { return handle[static_cast<std::size_t>(number) - 1] > 0.5; }
  /// How much there is a better handle than that part, 0 to 1.
  double passed_over(int number) const;
  bool has_handle() const;  ///< whether any part is_handle()
};
HoldScene hold_scene(const hand::Hand& hand, const product::Product& product,
                     const product::ProductParts& parts, const HoldOptions& options);

/// The trigger before a part; null if there is none.
const product::PartTrigger* trigger_of(const HoldScene& scene, const product::ProductPart& part);

/// The neck of a bottle goes on where its body ends; the body is what hands take.
bool is_neck(const product::ProductPart& part, const product::ProductParts& parts);

}  // namespace palmar::grasp
