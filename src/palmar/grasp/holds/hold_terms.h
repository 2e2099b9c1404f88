// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/holds/hold.h"
#include "palmar/grasp/holds/hold_site.h"

namespace palmar::grasp {

/// What the choice of a hold asks of a product, once for all its holds.
struct HoldScene {
  const hand::Hand* hand = nullptr;
  const product::Product* product = nullptr;
  const product::ProductParts* parts = nullptr;
  Vec3 gravity_centre = Vec3::Zero();  ///< of the product's volume, product frame, mm
  int part_of_gravity = -1;            ///< index of the part that it lies in or is nearest to
  double weight = 0.0;                 ///< N
  /// The product's up: as asked for, else of a body from its heavier to its lighter end.
  std::optional<Vec3> up;
  bool is_up_given = false;
  bool is_vessel = false;       ///< it has a hollow, whose mouth is up
  std::optional<Standing> lay;  ///< how it lies or stands where it is taken, if up is given
  /// By part: whether it is what the product has for the hand, a handle or a loop on something
  /// larger; and whether there is such a part at all.
  std::vector<char> is_handle;
  bool has_handle = false;
};
HoldScene hold_scene(const hand::Hand& hand, const product::Product& product,
                     const product::ProductParts& parts, const HoldOptions& options);

/// Reasons for and against a hold by the product's shape alone; docs/method/holds.md. `site` as
/// site_of() has it (of a precision grip: where its fingertips are, with `palm` any).
std::vector<HoldTerm> shape_terms(const HoldScene& scene, const Hold& hold, const HoldSite& site);

/// How well a closed hand goes with how the product lies, by the weights that were fitted to holds
/// of things that lay on a table: ln of how much rarer than the best. Only where that is known.
HoldTerm table_term(const HoldScene& scene, const HoldWeights& weights, const Grasp& grasp);
/// Its score of a power hold before the hand is closed, by where that would roughly be.
double rough_table_score(const HoldScene& scene, const HoldSite& at);

/// Where the working end sticks out from a site across its axis, beyond the hand on the thumb's
/// side: unit, product frame; nothing if it doesn't.
std::optional<Vec3> nose_of(const HoldScene& scene, const GripSite& site);

/// The trigger before a part; null if there is none.
const product::PartTrigger* trigger_of(const HoldScene& scene, const product::ProductPart& part);

double sum_of(const std::vector<HoldTerm>& terms);

}  // namespace palmar::grasp
