// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/study/statistics/study_results.h"

namespace palmar::workflow {

/// How differently the hands of a comparison hold the original and one redesign, over the hands
/// that hold both: where the same place of the product lies in the hand, and how it is turned
/// there.
struct HoldChange {
  std::string redesign;
  int hands = 0;
  double turn = 0.0, largest_turn = 0.0;    ///< median and largest, rad
  double shift = 0.0, largest_shift = 0.0;  ///< median and largest, mm
  /// The median is beyond 30 degrees or 10 mm: the redesign is held in another way, and a
  /// difference may be the hold's rather than the shape's.
  bool is_other_hold() const;
};

/// One per redesign; product 0 is the original, and `place` [product frame, mm] is where it is
/// held.
std::vector<HoldChange> hold_changes(const study::StudyResults& results, const Vec3& place);

/// For people, with the warning if it is another hold; nothing if no hand holds both.
std::string words_of(const HoldChange& change);

}  // namespace palmar::workflow
