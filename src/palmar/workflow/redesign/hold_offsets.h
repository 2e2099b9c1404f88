// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/workflow/redesign/candidate_study.h"

namespace palmar {

/// How far a hand lies from where the hold says: people don't take a thing at the same place twice.
struct HoldOffset {
  double along = 0.0;  ///< mm, towards the thumb's side of the hand
  double turn = 0.0;   ///< rad, about the part's axis
};

/// `count` (2 or more) offsets that stand for normally distributed ones with these standard
/// deviations: the middles of as many equally likely intervals along, each with another one of the
/// turn, so that both are spread evenly and independent of each other.
std::vector<HoldOffset> spread_offsets(int count, double along_deviation, double turn_deviation);

/// The hold with the hand so far elsewhere.
Hold moved_hold(const Hold& hold, const ProductPart& part, const HoldOffset& offset);

/// Grasps of one product at several offsets of one hold of the original, in one study: records
/// without fields, by offset, numbered as those of product `as` (0: the original, 1: the candidate)
/// in a plan of two products. Only hands for which `is_wanted` says so.
struct OffsetGrasps {
  const HeldOriginal& original;
  const Product& product;
  std::vector<HoldOffset> offsets;
  std::function<bool(int hand, std::size_t offset)> is_wanted;
  bool with_indices = false;
  int as = 0;
};
/// Throws UsageError if the original isn't held by a hold; Cancelled.
std::vector<std::vector<StudyRecord>> grasp_at_offsets(const OffsetGrasps& asked,
                                                       const Progress& progress);

/// The plan that those records are numbered in.
StudyPlan plan_of_two(const HeldOriginal& original);

}  // namespace palmar
