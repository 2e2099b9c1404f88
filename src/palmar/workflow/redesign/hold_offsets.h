// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/study/study_task.h"
#include "palmar/workflow/redesign/candidate_study.h"

namespace palmar::workflow {

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
grasp::Hold moved_hold(const grasp::Hold& hold, const product::ProductPart& part,
                       const HoldOffset& offset);

/// The original, a candidate or both held at several offsets of the hold of the original. Places
/// are found once, for however many hands.
class OffsetGrasps {
 public:
  struct Shape {
    const product::Product& product;
    int as = 0;  ///< its number in plan_of_two(): 0 the original, 1 the candidate
  };
  struct Asked {
    const HeldOriginal& original;
    std::vector<Shape> shapes;
    std::vector<HoldOffset> offsets;
    bool with_indices = false;
  };
  /// Throws UsageError if the original isn't held by a hold.
  explicit OffsetGrasps(const Asked& asked);
  OffsetGrasps(const OffsetGrasps&) = delete;
  OffsetGrasps& operator=(const OffsetGrasps&) = delete;

  using Wanted = std::function<bool(int hand, std::size_t offset)>;
  /// Records without fields, by offset, numbered as in plan_of_two(), ascending. Throws Cancelled.
  std::vector<std::vector<study::StudyRecord>> of(const Wanted& is_wanted,
                                                  const Progress& progress);

 private:
  records::LoadedStudy study_;  // a product per offset, of the first shape, of the second
  study::StudyPlan two_;
  std::size_t offsets_ = 0;
  std::vector<int> as_;  // by shape
  std::unique_ptr<study::StudyBench> bench_;
};

/// The plan that those records are numbered in.
study::StudyPlan plan_of_two(const HeldOriginal& original);

}  // namespace palmar::workflow
