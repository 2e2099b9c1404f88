// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/hold_value.h"
#include "palmar/grasp/holds/hold_weights.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// A hold with what speaks for and against it.
struct RankedHold {
  Hold hold;
  std::vector<HoldTerm> terms;
  double score = 0.0;   ///< sum of the terms; 0 at best
  std::string words;    ///< "medium wrap of the handle, 40 % along it, thumb towards the body"
  std::string against;  ///< the term that costs most, in words; "" if none costs much
  Grasp grasp;          ///< as the hand that it was searched with takes it, closed coarsely
};

/// What a product is to be held for: people hold the same thing in another way to use it than to
/// hand it over (Brahmbhatt et al. 2020, ECCV). To use it holds are ranked by shape_terms(), to
/// hand it over by weights that were fitted (offered_holds()).
enum class HoldPurpose { kUse, kHandOver };

struct HoldOptions {
  std::optional<Grip> grip;     ///< only holds of this grip; unset: any
  bool is_power_only = false;   ///< no precision grips
  std::optional<int> part;      ///< only this part (its number)
  std::string part_name;        ///< only parts of this name; "": any
  std::optional<Vec3> toward;   ///< where the thumb's side is to point, product frame
  std::optional<Vec3> up;       ///< the product's up where it is taken, product frame
  std::optional<double> mass;   ///< kg; unset: from the volume at 1 g/cm^3
  std::optional<double> along;  ///< fraction of the part's length, 0 to 1
  HoldPurpose purpose = HoldPurpose::kUse;
  /// How a hand holds another product that this one is to be compared with, product from hand: of
  /// holds that are as good, that which is turned least against it leads, and what is round is
  /// taken from the same side. Unset: the first of the candidates leads.
  std::optional<Quat> like;
  /// Of holds to hand over; null: hand_over_weights().
  std::shared_ptr<const HoldWeights> weights;
  double palm_limit_depth = 7.0;    ///< mm; as PowerGraspOptions
  double finger_limit_depth = 4.0;  ///< mm; as PowerGraspOptions
  int most = 8;                     ///< holds to return
  /// For fitting weights: ten times as many candidates, and all that the hand was closed on, alike
  /// or not.
  bool lists_all = false;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Ways of holding a product, as people would choose: best first, each unlike those before it. Of
/// holds whose scores are within 0.2 of the best, which the last digits decide, the one leads that
/// comes first among the candidates (HoldOptions::like).
struct RankedHolds {
  product::ProductParts parts;
  std::vector<RankedHold> holds;
  /// Whether the product says where the hand goes to use it: a handle, a loop, a trigger or rings.
  bool has_handle = false;
  int considered = 0;                       ///< holds that were scored by the product's shape
  int closed = 0;                           ///< of these, on how many the hand was closed
  HoldPurpose purpose = HoldPurpose::kUse;  ///< for which they were ranked
  int taken = 1;  ///< number of the one that is taken, from 1 (GraspPlace)
  /// Why that isn't the one that the product's shape suggests, in words; empty: it is, or the hold
  /// was asked for.
  std::string why_taken;
};

/// Number of a hold that is as likely as the one that is taken (within 0.2), but on another part or
/// the other way round: which of the two people mean the shape doesn't tell. Nothing if there is
/// none.
std::optional<int> other_as_likely(const RankedHolds& ranked);

/// Takes the product apart (find_parts()), scores the ways of holding each part by its shape,
/// closes the hand on the most promising and ranks them. `hand`: a median hand of those who use the
/// product. docs/method/holds.md has the terms and their sources. Deterministic. Throws UsageError
/// (also for a part that the product doesn't have: the message lists its parts), Cancelled.
RankedHolds rank_holds(const hand::Hand& hand, const product::Product& product,
                       const HoldOptions& options = {}, const Progress& progress = {});

/// For people: "medium wrap of the handle, 40 % along it, thumb towards the body".
std::string words_of(const Hold& hold, const product::ProductParts& parts);

}  // namespace palmar::grasp
